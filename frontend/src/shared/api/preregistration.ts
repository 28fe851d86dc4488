/** Requests about what a study declared beforehand. */
import { answer, server } from "./request";
import type { components } from "./schema";
import type { DataKind } from "./types";

type Schemas = components["schemas"];
export type Preregistration = Schemas["PreregistrationView"];
export type Declaration = Schemas["DeclarationView"];
export type PrimaryResult = Schemas["PrimaryResult"];
export type Deviation = Schemas["DeviationView"];

export const preregistrations = {
  get: (key: string, kind: DataKind) =>
    answer<Preregistration>(
      server.GET("/api/studies/{key}/preregistration", {
        params: { path: { key }, query: { kind } },
      }),
    ),
  reportUrl: (key: string, kind: DataKind, form: "markdown" | "json") =>
    `/api/studies/${encodeURIComponent(key)}/preregistration/report?kind=${kind}&form=${form}`,
};
