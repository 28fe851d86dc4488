/** Requests for a study's results and its preregistration. */
import { answer, server } from "./request";
import type { components } from "./schema";
import type { DataKind } from "./types";

type Schemas = components["schemas"];
export type Dashboard = Schemas["DashboardView"];
export type FigureEntry = Schemas["FigureView"];
export type FigureGroup = FigureEntry["group"];
export type FilterChoices = Schemas["FilterChoices"];
export type Statistics = Schemas["StatisticsView"];
export type Glance = Schemas["GlanceView"];
export type Effect = Schemas["EffectView"];
export type Measure = Schemas["MeasureView"];
export type Result = Schemas["ResultView"];

/** The filter that chooses which sessions are shown; null or empty means no restriction. */
export interface Filter {
  readonly kind: DataKind;
  readonly participant: readonly string[];
  readonly order: string | null;
  readonly rows: "valid" | "all";
  readonly since: string | null;
  readonly until: string | null;
  readonly limb: "hand" | "foot" | null;
  /** The body whose phases are drawn; null for the first if there are several to choose from. */
  readonly body: string | null;
}

/** The filter as URL query parameters; defaults are left out. */
export function searchOf(filter: Filter): URLSearchParams {
  const search = new URLSearchParams();
  if (filter.kind !== "people") search.set("kind", filter.kind);
  for (const code of filter.participant) search.append("participant", code);
  if (filter.rows !== "valid") search.set("rows", filter.rows);
  for (const name of ["order", "since", "until", "limb", "body"] as const) {
    const value = filter[name];
    if (value !== null && value !== "") search.set(name, value);
  }
  return search;
}

/** The filter in a URL's query parameters; invalid values are ignored. */
export function filterFrom(search: URLSearchParams): Filter {
  const one = <Word extends string>(name: string, known: readonly Word[]): Word | null =>
    known.find((word) => word === search.get(name)) ?? null;
  const day = (name: string): string | null =>
    /^\d{4}-\d\d-\d\d$/.test(search.get(name) ?? "") ? search.get(name) : null;
  return {
    kind: one("kind", ["people", "simulated", "test"]) ?? "people",
    participant: search.getAll("participant"),
    order: search.get("order"),
    rows: one("rows", ["valid", "all"]) ?? "valid",
    since: day("since"),
    until: day("until"),
    limb: one("limb", ["hand", "foot"]),
    body: search.get("body"),
  };
}

/**
 * Whether nothing can be drawn yet of simulated people who are on their way: the first answers make
 * the first figure. Of people the first figure waits for the end of their session, since drawing
 * takes time from the computer that they use.
 */
export const awaitsFirstFigure = (
  found: Pick<Dashboard, "simulated" | "n_running" | "figures"> | undefined,
): boolean =>
  found !== undefined &&
  found.simulated &&
  found.n_running > 0 &&
  found.figures.every(({ figure }) => figure === null);

export const analysis = {
  /** One group of figures, which is ready sooner than all of them. */
  dashboard: (key: string, filter: Filter, group: FigureGroup) =>
    answer<Dashboard>(
      server.GET("/api/studies/{key}/dashboard", {
        params: { path: { key }, query: { ...filter, group } },
      }),
    ),
  rowsUrl: (key: string, figure: string, filter: Filter) => {
    const search = searchOf(filter).toString();
    const path = `/api/studies/${encodeURIComponent(key)}/dashboard/${figure}/rows`;
    return search === "" ? path : `${path}?${search}`;
  },
  statistics: (key: string, kind: DataKind) =>
    answer<Statistics>(
      server.GET("/api/studies/{key}/statistics", { params: { path: { key }, query: { kind } } }),
    ),
};

export type Preregistration = Schemas["PreregistrationView"];
export type Declaration = Schemas["DeclarationView"];
export type PrimaryResult = Schemas["PrimaryResult"];
export type Deviation = Schemas["DeviationView"];

/** Requests for a study's preregistration. */
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
