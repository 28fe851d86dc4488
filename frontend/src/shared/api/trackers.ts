/** Requests for the doors of tracking software and the sources behind them. */
import { answer, server } from "./request";
import type { components } from "./schema";

type Schemas = components["schemas"];
export type Trackers = Schemas["LiveView"];
export type Door = Schemas["DoorView"];
export type DoorWish = Schemas["DoorWish"];
export type LimbWish = Schemas["LimbWish"];
export type Source = Schemas["SourceView"];
export type Tracker = Schemas["TrackerView"];

/** A session that is not over and uses a source of a door. */
export type SessionBehindDoor = Schemas["SessionBehindDoor"];
export type SessionTrackers = Schemas["SessionTrackers"];

export const trackers = {
  get: () => answer<Trackers>(server.GET("/api/trackers")),
  setDoor: (door: Door["door"], wish: DoorWish) =>
    answer<Trackers>(
      server.PUT("/api/trackers/doors/{door}", { params: { path: { door } }, body: wish }),
    ),
  sessionsBehind: (door: Door["door"]) =>
    answer<SessionBehindDoor[]>(
      server.GET("/api/trackers/doors/{door}/sessions", { params: { path: { door } } }),
    ),
  setLimb: (wish: LimbWish) => answer<Trackers>(server.PUT("/api/trackers/limbs", { body: wish })),
  /** Those that a session's headset uses. */
  ofSession: (session_id: string) =>
    answer<SessionTrackers>(
      server.GET("/api/sessions/{session_id}/trackers", { params: { path: { session_id } } }),
    ),
  choose: (session_id: string, wish: Pick<SessionTrackers, "door" | "source">) =>
    answer<SessionTrackers>(
      server.PUT("/api/sessions/{session_id}/trackers", {
        params: { path: { session_id } },
        body: wish,
      }),
    ),
};
