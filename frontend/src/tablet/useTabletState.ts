/**
 * The screen that the server wants shown, kept current by its live feed, and stored on the tablet
 * for times without a connection.
 */
import { tablet } from "@shared/api/endpoints";
import { type FeedState, openFeed } from "@shared/api/live";
import { ApiError, isUnauthorised } from "@shared/api/request";
import type { TabletState } from "@shared/api/types";
import { type QueryClient, useQuery, useQueryClient } from "@tanstack/react-query";
import { useCallback, useEffect, useState } from "react";
import { drafts } from "./drafts/drafts";
import { stateInPage } from "./stateInPage";

export const STATE_KEY = ["tablet", "state"] as const;

/** A server that takes longer to answer is treated as unreachable. */
const PATIENCE_MS = 4000;

export function useTabletState() {
  const queries = useQueryClient();
  const [feed, setFeed] = useState<FeedState>("connecting");
  const query = useQuery({
    queryKey: STATE_KEY,
    queryFn: () => stateIfPaired(queries),
    initialData: stateInPage,
    // Send the request even if the system reports no network: its failure brings up the stored
    // screen.
    networkMode: "always",
    // Without a connection the page polls; with one the feed reports every change.
    refetchInterval: ({ state }) => (state.error === null ? false : 5000),
  });
  useStoredScreen(query, queries);
  const paired = query.data !== undefined && query.error === null;
  const show = useCallback(
    (state: TabletState) => {
      queries.setQueryData<TabletState>(STATE_KEY, (previous) => newer(previous, state));
    },
    [queries],
  );
  useEffect(() => {
    if (!paired) return;
    return openFeed({
      url: tablet.liveUrl,
      onState: (state) => {
        setFeed(state);
        // A closed feed may mean that this tablet was disconnected: the state shows whether it was.
        if (state === "lost") void queries.invalidateQueries({ queryKey: STATE_KEY });
      },
      on: {
        state: (data) => show(data as TabletState),
      },
    });
  }, [paired, queries, show]);
  return { query, show, connected: paired && feed !== "lost" };
}

/**
 * Fetch the screen. A tablet that shows none yet first asks whether it is paired; an unauthorised
 * request every five seconds would fill the browser's console with errors.
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
 * Store every screen from the server, and show the last one if the page starts without an answer.
 *
 * A stored screen counts like an old answer: the feed finds that there is no connection, the bar
 * says
 * so, and the page keeps polling.
 */
function useStoredScreen(
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

/**
 * The newer of two states: answers and live events may overtake each other, so within one session
 * the higher version wins.
 */
function newer(known: TabletState | undefined, state: TabletState): TabletState {
  const sameSession = known !== undefined && known.session_id === state.session_id;
  return sameSession && known.version > state.version ? known : state;
}
