/** Requests for drafts of study files and for the library of instruments. */
import { answer, server } from "./request";
import type { components } from "./schema";
import type {
  CheckResult,
  Instrument,
  InstrumentCheck,
  InstrumentDetail,
  StudyDetail,
  StudySummary,
} from "./types";

type Schemas = components["schemas"];
export type Template = Schemas["TemplateView"];
export type Timeline = Schemas["TimelineView"];
export type TimelineStep = Schemas["TimelineStep"];
export type StudyDiff = Schemas["StudyDiff"];
export type Difference = Schemas["DifferenceView"];
export type VersionDetail = Schemas["VersionDetail"];
export type InstrumentSummary = Schemas["InstrumentSummary"];
export type TryResult = Schemas["TryResult"];
export type { Instrument };

interface DraftRequest {
  readonly path: readonly (string | number)[];
  readonly action: "set" | "remove" | "insert" | "move";
  readonly value?: unknown;
  readonly to?: number;
}

const study = (key: string) => ({ params: { path: { key } } });

export const drafts = {
  templates: () => answer<readonly Template[]>(server.GET("/api/templates")),
  schema: () => answer<unknown>(server.GET("/api/study-schema")),
  check: (yaml: string) =>
    answer<CheckResult>(server.POST("/api/studies/check", { body: { yaml } })),
  edit: (yaml: string, changes: readonly DraftRequest[]) =>
    answer<{ readonly yaml: string }>(
      server.POST("/api/studies/edit", {
        body: {
          yaml,
          changes: changes.map(({ path, action, value = null, to = 0 }) => ({
            path: [...path],
            action,
            value,
            to,
          })),
        },
      }),
    ),
  timeline: (yaml: string, slot: number, language: string) =>
    answer<Timeline>(server.POST("/api/studies/timeline", { body: { yaml, slot, language } })),
  diff: (key: string, yaml: string) =>
    answer<StudyDiff>(server.POST("/api/studies/{key}/diff", { ...study(key), body: { yaml } })),
};

export const versions = {
  get: (key: string, number: number) =>
    answer<VersionDetail>(
      server.GET("/api/studies/{key}/versions/{number}", { params: { path: { key, number } } }),
    ),
  diff: (key: string, from: number, to: number) =>
    answer<StudyDiff>(
      server.GET("/api/studies/{key}/diff", { params: { path: { key }, query: { from, to } } }),
    ),
  archived: () =>
    answer<readonly StudySummary[]>(
      server.GET("/api/studies", { params: { query: { archived: true } } }),
    ),
  duplicate: (key: string, copy: string) =>
    answer<StudyDetail>(
      server.POST("/api/studies/{key}/duplicate", { ...study(key), body: { key: copy } }),
    ),
  archive: (key: string) =>
    answer<StudyDetail>(server.POST("/api/studies/{key}/archive", study(key))),
  restore: (key: string) =>
    answer<StudyDetail>(server.POST("/api/studies/{key}/restore", study(key))),
};

export const instruments = {
  list: () => answer<readonly InstrumentSummary[]>(server.GET("/api/instruments")),
  get: (key: string) => answer<InstrumentDetail>(server.GET("/api/instruments/{key}", study(key))),
  check: (yaml: string) =>
    answer<InstrumentCheck>(server.POST("/api/instruments/check", { body: { yaml } })),
  save: (yaml: string) =>
    answer<InstrumentDetail>(server.POST("/api/instruments", { body: { yaml } })),
  score: (yaml: string, answers: Readonly<Record<string, string | number | boolean | null>>) =>
    answer<TryResult>(server.POST("/api/instruments/score", { body: { yaml, answers } })),
};
