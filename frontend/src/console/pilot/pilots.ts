/** What the page of pilots asks of the server. Everything in the answers is simulated. */
import { answer, isApiError, server } from "@shared/api/request";
import type { components } from "@shared/api/schema";
import { queryOptions } from "@tanstack/react-query";

type Schemas = components["schemas"];
export type Pilot = Schemas["PilotView"];
export type PilotListed = Schemas["PilotListed"];
export type PilotDefaults = Schemas["PilotDefaults"];
export type CohortFigures = Schemas["CohortFigures"];
export type PowerFigures = Schemas["PowerFigures"];
export type PowerPoint = Schemas["PowerPointView"];
export type NewPilot = Schemas["NewCohort"] | Schemas["NewPowerRun"];

const PATH = "/api/studies/{key}/pilots/{pilot_id}";
/** How often the progress is asked for, and what somebody else may have done. */
const EVERY_MS = 1000;
const OTHERS_MS = 5000;

const at = (key: string, id: string) => ({ params: { path: { key, pilot_id: id } } });
const ofStudy = (key: string) => ({ params: { path: { key } } });
const list = (key: string) => ["studies", key, "pilots"] as const;

export const pilots = {
  start: (key: string, body: NewPilot) =>
    answer<Pilot>(server.POST("/api/studies/{key}/pilots", { ...ofStudy(key), body })),
  stop: (key: string, id: string) => answer<Pilot>(server.POST(`${PATH}/stop`, at(key, id))),
  resume: (key: string, id: string) => answer<Pilot>(server.POST(`${PATH}/resume`, at(key, id))),
  remove: (key: string, id: string) => answer<void>(server.DELETE(PATH, at(key, id))),
  recordUrl: (key: string, id: string) =>
    `/api/studies/${encodeURIComponent(key)}/pilots/${id}/record`,
};

export const pilotsQuery = (key: string) =>
  queryOptions({
    queryKey: list(key),
    queryFn: () =>
      answer<readonly PilotListed[]>(server.GET("/api/studies/{key}/pilots", ofStudy(key))),
    refetchInterval: ({ state: { data } }) =>
      data?.some(({ state }) => state === "simulating") === true ? EVERY_MS : OTHERS_MS,
  });

export const pilotQuery = (key: string, id: string) =>
  queryOptions({
    queryKey: [...list(key), id],
    queryFn: () => answer<Pilot>(server.GET(PATH, at(key, id))),
    refetchInterval: ({ state: { data, error } }) => {
      if (isApiError(error, "not_found")) return false;
      return data?.state === "simulating" ? EVERY_MS : OTHERS_MS;
    },
  });

export const pilotDefaultsQuery = (key: string) =>
  queryOptions({
    queryKey: [...list(key), "", "defaults"],
    queryFn: () =>
      answer<PilotDefaults>(server.GET("/api/studies/{key}/pilot-defaults", ofStudy(key))),
    staleTime: Number.POSITIVE_INFINITY,
  });
