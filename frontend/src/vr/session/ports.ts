/** What the headset's loop needs of the parts it puts together, and no more. */
import type { Goals } from "@shared/avatar/goals";
import type { Bodies, BodiesFrame } from "../bodies/bodies";
import type { TimedRun } from "../tasks";
import type { HeadsetState } from "../telemetry";
import type { TrackedFrame } from "../tracking/tracked";

/** Turns poses of devices into those of the joints that they are worn on. */
export interface Calibrator {
  /** The participant's stature, if it was measured. */
  readonly statureM: number | null;
  goals(tracked: TrackedFrame): Goals;
}

/** Prepares the bodies of a session: that of the configuration, and those with a name. */
export type PrepareBodies = (statureM: number, named: readonly string[]) => Promise<Bodies>;

/**
 * Where the participant is in the visit: `standby` between steps, `stepping_in` while the
 * transparent figure waits, `acting` in the body, `over` after the end.
 */
export type Place = "standby" | "stepping_in" | "acting" | "over";

/** What is shown in one frame. */
export interface View {
  readonly timeS: number;
  readonly place: Place;
  readonly state: HeadsetState;
  readonly tracked: TrackedFrame;
  /** The bodies; null until they are prepared and have moved. */
  readonly bodies: BodiesFrame | null;
  /** The phase that runs; null between phases. */
  readonly run: TimedRun | null;
  /** The avatar stands still; the view never does. */
  readonly isFrozen: boolean;
  /** The room is hidden: the participant is in the pause room, or between two places. */
  readonly isCurtainDrawn: boolean;
}

export interface Scenery {
  show(view: View): void;
}
