/** The pre-flight of a session: asked for again while something is missing, and before a start. */
import { sessions } from "@shared/api/endpoints";
import type { SessionView } from "@shared/api/types";
import { useQuery, useQueryClient } from "@tanstack/react-query";
import { useState } from "react";
import { preflightQuery } from "../../queries";
import type { useSession } from "../session/useSession";
import { againAfter } from "./words";

/** After the list could not be made. */
const AGAIN_MS = 3000;

export type Flight = ReturnType<typeof usePreflight>;

/** `watched`: whether the list is in sight. */
export function usePreflight(
  session: SessionView,
  live: ReturnType<typeof useSession>,
  watched: boolean,
) {
  const queries = useQueryClient();
  const [asking, setAsking] = useState(false);
  const [looking, setLooking] = useState(false);
  const query = useQuery({
    ...preflightQuery(session.id),
    enabled: watched && session.ended_at === null,
    refetchOnMount: "always",
    // A page that nobody looks at does not ask.
    refetchInterval: ({ state }) =>
      state.data === undefined ? AGAIN_MS : againAfter(state.data.checks),
  });

  /** Start, or ask for the reason where a check has failed just now. */
  const start = async () => {
    if (looking) return;
    setLooking(true);
    try {
      const fresh = await queries.fetchQuery({ ...preflightQuery(session.id), staleTime: 0 });
      if (fresh.asks && !fresh.clear) return setAsking(true);
    } catch {
      // The list itself cannot be made: the start says why, if it is refused.
    } finally {
      setLooking(false);
    }
    live.send({ type: "start" });
  };

  return {
    query,
    start,
    looking,
    asking,
    stopAsking: () => setAsking(false),
    /** The list is there and nothing in it is open. */
    isClear: query.data?.clear === true,
  };
}

/** Put a reason on record for each of the checks. */
export async function overrideAll(
  id: string,
  checks: readonly { readonly key: Parameters<typeof sessions.override>[1] }[],
  reason: string,
): Promise<void> {
  for (const { key } of checks) await sessions.override(id, key, reason);
}
