/** What the headset's loop needs of the parts it puts together, and no more. */
import type { Bodies, BodiesFrame } from "../bodies/bodies";
import type { CalibrationPrompt, Measures } from "../calibration";
import type { FloorPlace, Others, RoadLink } from "../road";
import type { TimedRun } from "../tasks";
import type { HeadsetState } from "../telemetry";
import type { TrackedFrame } from "../tracking/tracked";

/** Prepares the bodies of a session: that of the configuration, and those with a name. */
export type PrepareBodies = (measures: Measures, named: readonly string[]) => Promise<Bodies>;

/**
 * Where the participant is in the visit: `standby` between steps, `calibrating` before there is a
 * body, `stepping_in` while the transparent figure waits, `acting` in the body, `over` after the end.
 */
export type Place = "standby" | "calibrating" | "stepping_in" | "acting" | "over";

/** The street around the participant, see `world/street.ts`. */
export interface StreetView {
  readonly sunkM: number;
  readonly others: Others;
  readonly activeS: number;
  /** The start square on the pavement, while the participant has to go there. */
  readonly showsStart: boolean;
}

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
  /** The study's road, while it is crossed; null in the room. */
  readonly street: StreetView | null;
  /** The avatar stands still; the view never does. */
  readonly isFrozen: boolean;
  /** The calibration that is under way, before the body or in it; null otherwise. */
  readonly calibration: CalibrationPrompt | null;
  readonly cover: Cover;
}

/** Opens the socket of the study's road for one phase. */
export type OpenRoad = (phaseId: number, activeS: number, place: FloorPlace) => RoadLink;

/** How the room is hidden: not, within 200 ms, or at once because it changes in this frame. */
export type Cover = "none" | "fade" | "cut";

/** What the participant is told and asked beside the scene, and how they stop. */
export interface Guide {
  /** Draw what is to be read in this frame; returns how the room is hidden. */
  follow(moment: Omit<View, "cover" | "bodies" | "isFrozen" | "street">): Cover;
}

export interface Scenery {
  show(view: View): void;
}
