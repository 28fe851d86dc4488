/** The body that the participant sees as their own and acts with. */

import type { Health } from "@shared/avatar/physics/simulation";
import type { AvatarOrder } from "../telemetry/wire/fromServer";

export interface RemoteBody {
  /** Root position and 22 local rotations at the last frame (91). */
  readonly pose: Float64Array;
  /** Its fingers at the last frame (120); null if the participant's are not given. */
  readonly fingers: Float64Array | null;
  /** By surface and part, at the last frame; see `BodiesFrame`. */
  readonly touched: Uint8Array;
  readonly near: Uint8Array;
  /** Whether it has taken the participant's pose since it was put on. */
  readonly hasMoved: boolean;
  readonly skippedGaps: number;
  readonly health: Health;
  /** Begin anew with the next frame, at rest in the participant's pose. */
  putOn(): void;
  setLatency(latencyS: number): void;
  showSurfaces(keys: readonly string[]): void;
  /** Bring the body to an order's changes; return the angle of each held axis. */
  change(order: AvatarOrder): Readonly<Record<string, number>>;
  /** Compute the body for the participant's own pose (91) and fingers (120). */
  frame(timeS: number, own: Float64Array, fingers: Float64Array | null): void;
  dispose(): void;
}
