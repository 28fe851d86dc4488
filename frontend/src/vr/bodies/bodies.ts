/**
 * The participant's two bodies: the local one, which shows what the tracking says, and the remote
 * one, which follows it and which the participant sees and acts with.
 *
 * `Bodies` hides where they are computed: in the page, or in a worker, whose result is one frame
 * old. `addedS` says what that adds to the latency; it is taken off the ordered latency as far as
 * possible, and recorded.
 */
import type { Goals } from "@shared/avatar/goals";
import type { Health } from "@shared/avatar/physics/simulation";
import type { AvatarOrder } from "../telemetry/wire/fromServer";

/** Root position x, y, z (m, world), then 22 local rotations w, x, y, z: as in the streams (91). */
export type PoseValues = Float64Array;

export interface BodiesInput {
  readonly timeS: number;
  /** Where the joints of the tracked parts are: devices with their calibrated offsets. */
  readonly goals: Goals;
  /** The fingers of both hands (120), NaN for a hand that is not tracked; null without fingers. */
  readonly fingers: Float64Array | null;
}

/** Both bodies at the time of one input; valid until the next step. */
export interface BodiesFrame {
  readonly timeS: number;
  readonly local: PoseValues;
  readonly remote: PoseValues;
  readonly localFingers: Float64Array | null;
  readonly remoteFingers: Float64Array | null;
  /** Distance of each goal that was not reached, in the order of `GOAL_PARTS`; NaN without one. */
  readonly goalErrorsM: Float64Array;
  /**
   * By surface of the layout shown and part of `touchingParts` (S x P, 0 or 1): what the remote
   * body touches, and what is near enough to keep a touch.
   */
  readonly touched: Uint8Array;
  readonly near: Uint8Array;
  /** Time that the computation took, ms, and how much of it inverse kinematics. */
  readonly tookMs: number;
  readonly ikMs: number;
  /** What the simulation had to put right since it started. */
  readonly health: Health;
}

/** A body cannot be changed as ordered while it runs; the message says why. */
export class CannotChange extends Error {
  override name = "CannotChange";
}

export interface Bodies {
  /** The parts whose touches are reported, in the order of `touched`. */
  readonly touchingParts: readonly string[];
  /** What the way of computing adds to the latency, s: 0 in the page, a frame in a worker. */
  readonly addedS: number;
  /** Put on a body that was prepared, by its name; null is the configuration's. At rest at first. */
  wear(body: string | null): void;
  setLatency(orderedS: number): void;
  /** Make the surfaces with these keys solid, and report touches of them; none removes all. */
  showSurfaces(keys: readonly string[]): void;
  /**
   * Apply an operator's or a study's changes, as soon as the body has taken the participant's pose;
   * resolves to the angle of every held axis, rejects with `CannotChange`. A body that is put on
   * later is changed likewise, without being asked for.
   */
  change(order: AvatarOrder): Promise<Readonly<Record<string, number>>>;
  /** Compute this frame; `latest` shows the result, at once or one frame later. */
  step(input: BodiesInput): void;
  /** The newest result; null before the first. */
  latest(): BodiesFrame | null;
  /** Gaps that were skipped instead of simulated. */
  readonly skippedGaps: number;
  dispose(): void;
}
