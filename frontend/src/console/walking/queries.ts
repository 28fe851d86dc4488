/** The queries about walking. */
import {
  type ModelListed,
  type PredictionRequest,
  type SliceRequest,
  walking,
} from "@shared/api/walking";
import { keepPreviousData, queryOptions } from "@tanstack/react-query";

const WHILE_FITTING_MS = 1000;

export const scenesQuery = queryOptions({
  queryKey: ["walking", "scenes"],
  queryFn: walking.scenes,
});

export const sceneQuery = (key: string) =>
  queryOptions({ queryKey: ["walking", "scenes", key], queryFn: () => walking.scene(key) });

export const populationsQuery = queryOptions({
  queryKey: ["walking", "populations"],
  queryFn: walking.populations,
  staleTime: Number.POSITIVE_INFINITY,
});

export const walkSetsQuery = queryOptions({
  queryKey: ["walking", "sets"],
  queryFn: walking.walkSets,
});

export const modelsQuery = queryOptions({
  queryKey: ["walking", "models"],
  queryFn: walking.models,
  refetchInterval: (query) => (query.state.data?.some(isFitting) ? WHILE_FITTING_MS : false),
});

export const modelQuery = (id: string) =>
  queryOptions({
    queryKey: ["walking", "models", id],
    queryFn: () => walking.model(id),
    refetchInterval: (query) =>
      query.state.data !== undefined && isFitting(query.state.data) ? WHILE_FITTING_MS : false,
  });

export const predictionQuery = (id: string, request: PredictionRequest) =>
  queryOptions({
    queryKey: ["walking", "prediction", id, request],
    queryFn: () => walking.predict(id, request),
    staleTime: Number.POSITIVE_INFINITY,
    placeholderData: keepPreviousData,
    retry: false,
  });

export const sliceQuery = (id: string, request: SliceRequest) =>
  queryOptions({
    queryKey: ["walking", "slice", id, request],
    queryFn: () => walking.slice(id, request),
    staleTime: Number.POSITIVE_INFINITY,
    placeholderData: keepPreviousData,
    retry: false,
  });

const isFitting = (model: Pick<ModelListed, "state">): boolean => model.state === "fitting";
