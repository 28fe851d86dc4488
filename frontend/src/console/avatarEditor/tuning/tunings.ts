/** What the tuning panel asks of the server. */
import { answer, isApiError, server } from "@shared/api/request";
import type { components } from "@shared/api/schema";
import { queryOptions } from "@tanstack/react-query";
import type { AvatarFile } from "../axes";

type Schemas = components["schemas"];
export type Tuning = Schemas["TuningView"];
export type TuningListed = Schemas["TuningListed"];
export type TunedAxis = Schemas["TunedAxis"];
export type TuningChoice = Schemas["TuningChoice"];
export type AxisCurves = Schemas["AxisCurvesView"];
export type Comparison = Schemas["ComparisonView"];
export type GainChange = Schemas["GainChangeView"];
/** What is tuned: a stored version, or a configuration that is not saved. */
export type Tuned =
  | { readonly avatar: { readonly key: string; readonly version: number } }
  | { readonly configuration: AvatarFile };

const at = (id: string) => ({ params: { path: { tuning_id: id } } });
const PATH = "/api/avatar-tunings/{tuning_id}";
const LIST = ["tunings"] as const;
/** How often the progress is asked for. */
const EVERY_MS = 700;
/** How often what somebody else may have done is asked for. */
const OTHERS_MS = 5000;

export const tunings = {
  start: (tuned: Tuned, options: TuningChoice) =>
    answer<Tuning>(
      server.POST("/api/avatar-tunings", { body: { ...tuned, stature_m: 1.75, options } }),
    ),
  stop: (id: string) => answer<Tuning>(server.POST(`${PATH}/stop`, at(id))),
  resume: (id: string) => answer<Tuning>(server.POST(`${PATH}/resume`, at(id))),
  remove: (id: string) => answer<void>(server.DELETE(PATH, at(id))),
  accept: (id: string, accepted: readonly string[]) =>
    answer<Schemas["AcceptedConfiguration"]>(
      server.POST(`${PATH}/configuration`, { ...at(id), body: { accepted } }),
    ),
  compare: (
    id: string,
    accepted: readonly string[],
    captureId: string | null,
    signal?: AbortSignal,
  ) =>
    answer<Comparison>(
      server.POST(`${PATH}/comparison`, {
        ...at(id),
        body: { accepted, capture_id: captureId, longest_s: 20 },
        ...(signal === undefined ? {} : { signal }),
      }),
    ),
};

export const tuningsQuery = queryOptions({
  queryKey: LIST,
  queryFn: () => answer<readonly TuningListed[]>(server.GET("/api/avatar-tunings")),
  refetchInterval: OTHERS_MS,
});

export const tuningQuery = (id: string) =>
  queryOptions({
    queryKey: [...LIST, id],
    queryFn: () => answer<Tuning>(server.GET(PATH, at(id))),
    refetchInterval: ({ state: { data, error } }) => {
      if (isApiError(error, "not_found")) return false;
      // Also what is ready may be discarded, and what is stopped may be resumed, by somebody else.
      return data?.state === "tuning" ? EVERY_MS : OTHERS_MS;
    },
  });

/** The configuration as it was before the tuning. */
export const tunedConfigurationQuery = (id: string) =>
  queryOptions({
    queryKey: [...LIST, id, "before"],
    queryFn: async () => (await tunings.accept(id, [])).configuration,
    staleTime: Number.POSITIVE_INFINITY,
  });

export const curvesQuery = (id: string, axis: string) =>
  queryOptions({
    queryKey: [...LIST, id, "curves", axis],
    queryFn: () =>
      answer<AxisCurves>(
        server.GET(`${PATH}/axes/{axis}`, { params: { path: { tuning_id: id, axis } } }),
      ),
    staleTime: Number.POSITIVE_INFINITY,
  });
