/**
 * Performers: skeletons that tracking software sends, watched on a body over a WebSocket, and
 * recorded. `app/features/movement/performers/socket.py` describes the messages.
 */
import { type LiveSocket, openLiveSocket } from "./liveSocket";
import { answer, server } from "./request";
import type { components } from "./schema";

type Schemas = components["schemas"];
export type Performers = Schemas["PerformersView"];
export type Performer = Schemas["PerformerView"];
export type PerformerWish = Schemas["PerformerWish"];
export type AgreedPose = Schemas["PoseWish"]["pose"];
export type Recording = Schemas["RecordingView"];
export type RecordingStored = Schemas["RecordingStored"];
export type GroundKey = "flat" | "ramp" | "kerb" | "steps";
type Place = readonly [x: number, z: number];

export const performers = {
  get: () => answer<Performers>(server.GET("/api/trackers/performers")),
  agree: (wish: PerformerWish, pose: AgreedPose) =>
    answer<Performers>(server.POST("/api/trackers/performers/pose", { body: { ...wish, pose } })),
  record: (wish: PerformerWish) =>
    answer<Recording>(server.POST("/api/trackers/recordings", { body: wish })),
  store: (recording_id: string) =>
    answer<RecordingStored>(
      server.POST("/api/trackers/recordings/{recording_id}/capture", {
        params: { path: { recording_id } },
      }),
    ),
  discard: (recording_id: string) =>
    answer<undefined>(
      server.DELETE("/api/trackers/recordings/{recording_id}", {
        params: { path: { recording_id } },
      }),
    ),
};

/** What is needed to draw the body. */
export interface BodySetup {
  readonly type: "setup";
  /** Null for the skeleton of a capture, which no body of the lab can be drawn on. */
  readonly stature_m: number | null;
  /** Body joint -> joint. */
  readonly joint_map: Readonly<Record<string, string>>;
  readonly joints: readonly string[];
  readonly parents: readonly number[];
  readonly offsets_m: readonly (readonly [x: number, y: number, z: number])[];
  /** Where uneven ground begins and where it rises to; null where the ground is flat. */
  readonly ground_start_m: Place | null;
  readonly uphill: Place | null;
  /** Corners of the ground: distance from its start, and height; the last one continues. */
  readonly profile_m: readonly (readonly [distance: number, height: number])[];
  readonly scale: number;
  readonly unmapped: readonly string[];
}

/** Why the body moves or does not; `refused` if there is no such body. */
export interface BodyState {
  readonly type: "state";
  readonly state: "refused" | "absent" | "silent" | "gathering" | "unusable" | "ready";
  readonly address: string | null;
  /** Addresses of other senders of this name. */
  readonly others: readonly string[];
  readonly missing: readonly string[];
  readonly problems: readonly string[];
}

export interface BodyPose {
  /** Bones of the performer whose pose was lost or not sent. */
  readonly held: number;
  readonly number: number;
  /** Frames that were left out for this page. */
  readonly skipped: number;
  /** From the packet's arrival to its sending to this page, seconds. */
  readonly delayS: number;
  /** The place of the hips in metres, then each joint's rotation wxyz in its parent's frame. */
  readonly values: Float32Array;
}

const HEADER_BYTES = 36;
const MAGIC = "RLB1";

/** The pose in a binary message; null if the bytes are not one. */
export function decodeBodyPose(bytes: ArrayBuffer): BodyPose | null {
  if (bytes.byteLength < HEADER_BYTES) return null;
  const view = new DataView(bytes);
  const count = view.getUint16(4, true);
  const magic = String.fromCharCode(...new Uint8Array(bytes, 0, 4));
  if (magic !== MAGIC || bytes.byteLength !== HEADER_BYTES + 4 * count) return null;
  return {
    held: view.getUint16(6, true),
    number: view.getUint32(8, true),
    skipped: view.getUint32(12, true),
    delayS: view.getFloat32(32, true),
    values: Float32Array.from({ length: count }, (_, at) =>
      view.getFloat32(HEADER_BYTES + 4 * at, true),
    ),
  };
}

export interface BodyWish extends PerformerWish {
  /** A stature, such as `165cm`, or the id of a capture, whose skeleton is the body. */
  readonly avatar: string;
  readonly ground: GroundKey;
}

export interface BodyFeedOptions {
  readonly wish: BodyWish;
  readonly onSetup: (setup: BodySetup) => void;
  readonly onState: (state: BodyState) => void;
  readonly onPose: (pose: BodyPose) => void;
  readonly onLost: () => void;
  readonly open?: (url: string) => WebSocket;
}

/** Not signed in, not allowed, and a request that is not understood: trying again is no use. */
const REFUSED = [4401, 4403, 1008];

/** Open the feed; it reconnects automatically after a broken connection. */
export function openBody(options: BodyFeedOptions): LiveSocket {
  return openLiveSocket({
    url: `/api/trackers/performers/watch?${new URLSearchParams({ ...options.wish })}`,
    refused: REFUSED,
    onLost: options.onLost,
    open: options.open,
    onMessage: (data) => {
      if (data instanceof ArrayBuffer) {
        const pose = decodeBodyPose(data);
        if (pose !== null) options.onPose(pose);
        return;
      }
      const message = JSON.parse(String(data)) as BodySetup | BodyState;
      if (message.type === "setup") options.onSetup(message);
      else options.onState(message);
    },
  });
}
