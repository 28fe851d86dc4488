/**
 * The live movement of a session over a WebSocket.
 *
 * Poses arrive as binary messages (`app/features/record/headset/poses.py` describes the layout),
 * everything else as JSON. The client acknowledges each drawn pose with `drawn`: the server never
 * has
 * more than a few on the way, so the newest pose is shown, however slow the page is.
 */
import type { FeedState } from "./live";
import { type LiveSocket, openLiveSocket } from "./liveSocket";

export type PoseStream = "target" | "actual";
type Vector = readonly [x: number, y: number, z: number];

export interface PoseSurface {
  readonly key: string;
  readonly kind: "panel" | "side" | "target" | "start";
  readonly box: number | null;
  readonly center_m: Vector;
  readonly half_size_m: Vector;
}

/** What is needed to draw poses; blinded operators get the participant's figure only. */
export interface PoseSetup {
  readonly type: "setup";
  readonly blinded: boolean;
  readonly simulated: boolean;
  readonly recording: boolean;
  readonly limb: "hand" | "foot" | null;
  readonly stature_m: number;
  readonly stature_known: boolean;
  readonly joints: readonly string[];
  readonly parents: readonly number[];
  readonly offsets_m: readonly Vector[];
  readonly surfaces: readonly PoseSurface[];
  /** The body that the avatar wears: its model's hash. Left out or null for none. */
  readonly body?: { readonly hash: string } | null;
}

/** A finished contact or a completed task. */
export interface PoseTouch {
  readonly number: readonly [epoch: number, seq: number];
  readonly phase_id: number;
  readonly kind: PoseSurface["kind"] | "completion";
  readonly effect: string;
  readonly surface: string | null;
  readonly part: string | null;
}

export interface Pose {
  readonly stream: PoseStream;
  /** Whether the phase's clock was running. */
  readonly running: boolean;
  readonly phaseId: number;
  /** Reading of the client's clock, seconds. */
  readonly time: number;
  /** Root position in metres, then for each joint a rotation wxyz in its parent's frame. */
  readonly values: Float32Array;
}

/** The fingers of a body, in sessions that record them. */
export interface FingerPose extends Omit<Pose, "values"> {
  /**
   * For each of the `FINGER_PARTS` a rotation wxyz in its parent's frame, relative to the
   * T-pose; NaN throughout for a hand that is not tracked.
   */
  readonly values: Float32Array;
}

const HEADER_BYTES = 28;
const MAGIC = "RMP1";

/** The pose of a body in a binary message; null if the bytes are not one. */
export function decodePose(bytes: ArrayBuffer): Pose | null {
  return decoded(bytes, { 1: "target", 2: "actual" });
}

/** The pose of a body's fingers in a binary message; null if the bytes are not one. */
export function decodeFingers(bytes: ArrayBuffer): FingerPose | null {
  return decoded(bytes, { 3: "target", 4: "actual" });
}

function decoded(bytes: ArrayBuffer, streams: Readonly<Record<number, PoseStream>>): Pose | null {
  if (bytes.byteLength < HEADER_BYTES) return null;
  const view = new DataView(bytes);
  const magic = String.fromCharCode(...new Uint8Array(bytes, 0, 4));
  const count = view.getUint16(6, true);
  if (magic !== MAGIC || bytes.byteLength !== HEADER_BYTES + 4 * count) return null;
  const stream = streams[view.getUint8(4)];
  if (stream === undefined) return null;
  return {
    stream,
    running: (view.getUint8(5) & 1) === 1,
    phaseId: view.getUint32(8, true),
    time: view.getFloat64(20, true),
    values: Float32Array.from({ length: count }, (_, at) =>
      view.getFloat32(HEADER_BYTES + 4 * at, true),
    ),
  };
}

export interface PoseFeedOptions {
  readonly url: string;
  readonly onState: (state: FeedState) => void;
  readonly onSetup: (setup: PoseSetup) => void;
  readonly onPose: (pose: Pose) => void;
  /** Called for the fingers of a body; they need not be acknowledged. */
  readonly onFingers?: (fingers: FingerPose) => void;
  readonly onTouches: (touches: readonly PoseTouch[]) => void;
  readonly open?: (url: string) => WebSocket;
}

/** Close codes for "not signed in" and "no access to this session": retrying would not help. */
const REFUSED = [4401, 4403];

/** Open the feed; it reconnects automatically after a broken connection. */
export function openPoses(options: PoseFeedOptions): LiveSocket {
  const receive = (data: unknown) => {
    if (data instanceof ArrayBuffer) {
      const pose = decodePose(data);
      if (pose !== null) return options.onPose(pose);
      const fingers = decodeFingers(data);
      if (fingers !== null) options.onFingers?.(fingers);
      return;
    }
    const message = JSON.parse(String(data)) as
      | PoseSetup
      | { readonly type: "touches"; readonly touches: readonly PoseTouch[] };
    if (message.type === "touches") return options.onTouches(message.touches);
    options.onState("live");
    options.onSetup(message);
  };
  options.onState("connecting");
  return openLiveSocket({
    url: options.url,
    refused: REFUSED,
    onMessage: receive,
    onLost: () => options.onState("lost"),
    open: options.open,
  });
}
