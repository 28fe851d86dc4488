/** The reads of a replay. Both are of a phase that is over, so they hardly ever change. */
import { replays } from "@shared/api/replays";
import { queryOptions } from "@tanstack/react-query";
import type { PhaseRef } from "./address";

export const replayQuery = ({ session, phase }: PhaseRef) =>
  queryOptions({
    queryKey: ["sessions", session, "replay", phase],
    queryFn: () => replays.get(session, phase),
    staleTime: 60_000,
    retry: false,
  });

export const movementQuery = ({ session, phase }: PhaseRef, view: string) =>
  queryOptions({
    queryKey: ["sessions", session, "replay", phase, "movement", view],
    queryFn: () => replays.movement(session, phase),
    staleTime: Number.POSITIVE_INFINITY,
    // Some megabytes each: the browser keeps them, too, and asks whether they are the same.
    gcTime: 60_000,
    retry: false,
  });
