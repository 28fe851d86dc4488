/** Requests for consents, experts' suggestions, the equipment's latency and headsets' self-tests. */
import { answer, server } from "./request";
import type { components } from "./schema";
import type { TabletState } from "./types";

type Schemas = components["schemas"];
export type ConsentForm = Schemas["ConsentForm"];
export type ConsentRecord = Schemas["ConsentRecord"];
export type ConsentGiven = Schemas["ConsentGiven"];
export type Suggestion = Schemas["SuggestionView"];
export type NewSuggestion = Schemas["NewSuggestion"];
export type Calibration = Schemas["CalibrationView"];
export type SelfTest = Schemas["SelfTestView"];
export type NewCalibration = Schemas["NewCalibration"];

export const consents = {
  ofSession: (id: string) =>
    answer<ConsentRecord | null>(
      server.GET("/api/sessions/{session_id}/consent", { params: { path: { session_id: id } } }),
    ),
  give: (given: ConsentGiven) =>
    answer<TabletState>(server.POST("/api/tablet/consent", { body: given })),
};

export const suggestions = {
  ofStudy: (key: string) =>
    answer<readonly Suggestion[]>(
      server.GET("/api/studies/{key}/suggestions", { params: { path: { key } } }),
    ),
  add: (key: string, wish: NewSuggestion) =>
    answer<Suggestion>(
      server.POST("/api/studies/{key}/suggestions", { params: { path: { key } }, body: wish }),
    ),
  decide: (id: string, status: "adopted" | "declined", adoptedIn: number | null) =>
    answer<Suggestion>(
      server.POST("/api/suggestions/{suggestion_id}/decision", {
        params: { path: { suggestion_id: id } },
        body: { status, adopted_in: adoptedIn },
      }),
    ),
};

export const calibrations = {
  list: () => answer<readonly Calibration[]>(server.GET("/api/calibrations")),
  add: (wish: NewCalibration) =>
    answer<Calibration>(server.POST("/api/calibrations", { body: wish })),
  retire: (id: string, reason: string) =>
    answer<Calibration>(
      server.POST("/api/calibrations/{calibration_id}/retire", {
        params: { path: { calibration_id: id } },
        body: { reason },
      }),
    ),
};

export const selfTests = {
  list: () => answer<readonly SelfTest[]>(server.GET("/api/headset-tests")),
};
