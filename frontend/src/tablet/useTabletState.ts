/** The screen the server wants, kept current by its live feed. */
import { tablet } from "@shared/api/endpoints";
import { type FeedState, openFeed } from "@shared/api/live";
import type { TabletState } from "@shared/api/types";
import { useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect, useState } from "react";

export const STATE_KEY = ["tablet", "state"] as const;

export function useTabletState() {
  const queries = useQueryClient();
  const [feed, setFeed] = useState<FeedState>("connecting");
  const query = useQuery({
    queryKey: STATE_KEY,
    queryFn: tablet.state,
    // Without a connection the page goes on asking; with one the feed tells of every change.
    refetchInterval: ({ state }) => (state.error === null ? false : 5000),
  });
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

/** Answers and live events may cross on the line; of one session the higher version stays. */
function newer(known: TabletState | undefined, state: TabletState): TabletState {
  const sameSession = known !== undefined && known.session_id === state.session_id;
  return sameSession && known.version > state.version ? known : state;
}
