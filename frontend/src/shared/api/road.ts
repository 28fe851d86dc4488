/** Requests for the road that a session's participant crosses. */
import { answer, server } from "./request";
import type { components } from "./schema";

export type SessionRoad = components["schemas"]["SessionRoad"];
export type RoadRun = SessionRoad["runs"][number];
export type Crossing = RoadRun["crossings"][number];

export const road = {
  ofSession: (session_id: string) =>
    answer<SessionRoad>(
      server.GET("/api/sessions/{session_id}/road", { params: { path: { session_id } } }),
    ),
};

/** Where the record of a run is downloaded from. */
export const roadRecordOf = (sessionId: string, runId: string): string =>
  `/api/sessions/${encodeURIComponent(sessionId)}/road/${encodeURIComponent(runId)}`;
