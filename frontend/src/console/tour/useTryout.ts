/** The scripted participant: whether one is here, beginning and stopping it. */
import { tryouts } from "@shared/api/housekeeping";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { tryoutQuery } from "../queries";

/** `enabled`: nobody who may not start one is asked for it. */
export function useTryout(enabled: boolean) {
  const query = useQuery({ ...tryoutQuery, enabled });
  return query.data ?? null;
}

interface Wish {
  readonly studyKey: string;
  readonly language: string;
}

export function useStartTryout() {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: ({ studyKey, language }: Wish) => tryouts.start(studyKey, language),
    onSuccess: (started) => queries.setQueryData(tryoutQuery.queryKey, started),
  });
}

export function useStopTryout() {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: tryouts.stop,
    onSuccess: (stopped) => queries.setQueryData(tryoutQuery.queryKey, stopped),
  });
}
