/** Requests for the companion of a session: a performer whom its participant sees. */
import { answer, server } from "./request";
import type { components } from "./schema";

type Schemas = components["schemas"];
export type SessionCompanion = Schemas["SessionCompanion"];
export type CompanionWish = Schemas["CompanionWish"];
export type CompanionPlace = CompanionWish["place"];

export const companions = {
  ofSession: (session_id: string) =>
    answer<SessionCompanion>(
      server.GET("/api/sessions/{session_id}/companion", { params: { path: { session_id } } }),
    ),
  /** Null: the participant sees nobody any more. */
  choose: (session_id: string, companion: CompanionWish | null) =>
    answer<SessionCompanion>(
      server.PUT("/api/sessions/{session_id}/companion", {
        params: { path: { session_id } },
        body: { companion },
      }),
    ),
};
