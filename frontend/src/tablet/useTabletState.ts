/** The screen the server wants, kept current by its live feed, and on the tablet for bad times. */
import { tablet } from "@shared/api/endpoints";
import { type FeedState, openFeed } from "@shared/api/live";
import { ApiError, isUnauthorised } from "@shared/api/request";
import type { TabletState } from "@shared/api/types";
import { type QueryClient, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect, useState } from "react";
import { drafts } from "./drafts/useKept";

export const STATE_KEY = ["tablet", "state"] as const;

/** A server that takes longer to answer is treated like one that is not there. */
const PATIENCE_MS = 4000;

export function useTabletState() {
  const queries = useQueryClient();
  const [feed, setFeed] = useState<FeedState>("connecting");
  const query = useQuery({
    queryKey: STATE_KEY,
    queryFn: () => stateIfPaired(queries),
    // Asked also where the system says there is no network: to fail is what brings the kept screen.
    networkMode: "always",
    // Without a connection the page goes on asking; with one the feed tells of every change.
    refetchInterval: ({ state }) => (state.error === null ? false : 5000),
  });
  useKeptScreen(query, queries);
  const paired = query.data !== undefined && query.error === null;
  useEffect(() => {
    if (!paired) return;
    return openFeed({
      url: tablet.liveUrl,
      onState: (state) => {
        setFeed(state);
        // A closed feed may mean that this tablet was disconnected: the state says so.
        if (state === "lost") void queries.invalidateQueries({ queryKey: STATE_KEY });
      },
      on: {
        state: (data) =>
          queries.setQueryData<TabletState>(STATE_KEY, (known) =>
            newer(known, data as TabletState),
          ),
      },
    });
  }, [paired, queries]);
  return { query, connected: paired && feed !== "lost" };
}

/**
 * The screen. A tablet that shows none yet asks first whether it is paired, which is no error in the
 * browser's console, as a refused request would be, every five seconds.
 */
async function stateIfPaired(queries: QueryClient): Promise<TabletState> {
  const known = queries.getQueryState<TabletState>(STATE_KEY);
  if (known?.data === undefined || isUnauthorised(known.error)) {
    const { state } = await tablet.paired();
    if (state === null) throw new ApiError(401, { code: "not_signed_in", message: "not paired" });
    return state;
  }
  return tablet.state();
}

type StateQuery = Pick<
  ReturnType<typeof useQuery<TabletState>>,
  "data" | "error" | "failureReason" | "isSuccess"
>;

/**
 * Keeps every screen of the server, and shows the last one when the page starts without an answer.
 *
 * A kept screen counts like an answer of long ago: the feed finds that there is no connection, the
 * bar says so, and the page goes on asking.
 */
function useKeptScreen(
  { data, error, failureReason, isSuccess }: StateQuery,
  queries: QueryClient,
): void {
  useEffect(() => {
    if (data !== undefined && isSuccess) void drafts.keepScreen(data);
  }, [data, isSuccess]);
  const unpaired = isUnauthorised(error);
  useEffect(() => {
    if (unpaired) void drafts.forgetScreen();
  }, [unpaired]);
  const nothing = data === undefined && !unpaired;
  const failed = failureReason !== null;
  useEffect(() => {
    if (!nothing) return;
    const show = async () => {
      const last = await drafts.lastScreen();
      if (last !== undefined && queries.getQueryData(STATE_KEY) === undefined) {
        queries.setQueryData<TabletState>(STATE_KEY, last);
      }
    };
    const timer = setTimeout(() => void show(), failed ? 0 : PATIENCE_MS);
    return () => clearTimeout(timer);
  }, [nothing, failed, queries]);
}

/** Answers and live events may cross on the line; of one session the higher version stays. */
function newer(known: TabletState | undefined, state: TabletState): TabletState {
  const sameSession = known !== undefined && known.session_id === state.session_id;
  return sameSession && known.version > state.version ? known : state;
}
