/** The pre-flight of a session: refreshed while something is missing, and before a start. */
import { sessions } from "@shared/api/endpoints";
import type { SessionView } from "@shared/api/types";
import { useQuery, useQueryClient } from "@tanstack/react-query";
import { useState } from "react";
import { preflightQuery } from "../../queries";
import type { useSession } from "../session/useSession";
import { refetchIntervalFor } from "./checkTexts";

/** The delay before a retry when the list could not be loaded. */
const RETRY_MS = 3000;

export type Flight = ReturnType<typeof usePreflight>;

/** `watched`: whether the list is visible. */
export function usePreflight(
  session: SessionView,
  live: ReturnType<typeof useSession>,
  watched: boolean,
) {
  const queries = useQueryClient();
  const [needsReason, setNeedsReason] = useState(false);
  const [isChecking, setIsChecking] = useState(false);
  const query = useQuery({
    ...preflightQuery(session.id),
    enabled: watched && session.ended_at === null,
    refetchOnMount: "always",
    // A hidden page does not poll.
    refetchInterval: ({ state }) =>
      state.data === undefined ? RETRY_MS : refetchIntervalFor(state.data.checks),
  });

  /** Start, or ask for a reason if a check has just failed. */
  const start = async () => {
    if (isChecking) return;
    setIsChecking(true);
    try {
      const fresh = await queries.fetchQuery({ ...preflightQuery(session.id), staleTime: 0 });
      if (fresh.asks && !fresh.clear) return setNeedsReason(true);
    } catch {
      // The list cannot be loaded: if the start is refused, its error says why.
    } finally {
      setIsChecking(false);
    }
    live.send({ type: "start" });
  };

  return {
    query,
    start,
    looking: isChecking,
    asking: needsReason,
    dismissReason: () => setNeedsReason(false),
    /** Whether the list is loaded and has no open check. */
    isClear: query.data?.clear === true,
  };
}

/** Record a reason for each of the checks. */
export async function overrideAll(
  id: string,
  checks: readonly { readonly key: Parameters<typeof sessions.override>[1] }[],
  reason: string,
): Promise<void> {
  for (const { key } of checks) await sessions.override(id, key, reason);
}
