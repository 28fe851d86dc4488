/**
 * From what devices report to where the joints below them are, frame by frame: the goals of inverse
 * kinematics.
 *
 * A device that was calibrated is used with the person's own offset; any other (before calibration,
 * or a controller taken up by somebody who was calibrated with bare hands) with the usual one. Hips
 * without a waist tracker have no goal: inverse kinematics infers them from head and shins.
 */
import { GOAL_PARTS, type Goals, NO_GOALS } from "@shared/avatar/goals";
import type { Place } from "@shared/avatar/hips";
import { plus, rotate, type Vector } from "@shared/rotations";
import { AT_ORIGIN, composed, inverted } from "../tracking/places";
import type { GoalPart, TrackedFrame, TrackingDevice } from "../tracking/tracked";
import { usualOffsets, type WornOffsets } from "../tracking/worn";
import type { Calibration } from "./calibration";
import { trackedBy } from "./fitting";

/** The stature of a participant of whom nothing is known yet, m. */
export const USUAL_STATURE_M = 1.72;
const NOT_SWAPPED = { swapsHands: false, swapsShins: false } as const;
const NO_SHIFTS: Readonly<Record<string, Vector>> = {};

type MutableGoals = { -readonly [Part in GoalPart]: Place | null };

export class Calibrator {
  #calibration: Calibration | null = null;
  #usual: Readonly<Record<GoalPart, Place>> = fromDevices(usualOffsets(USUAL_STATURE_M));
  #usualOf = USUAL_STATURE_M;
  #shiftsM = NO_SHIFTS;
  readonly #goals: MutableGoals = { ...NO_GOALS };

  get calibration(): Calibration | null {
    return this.#calibration;
  }

  /** Use a calibration from now on, without the shifts that were made to the one before. */
  use(calibration: Calibration): void {
    this.#calibration = calibration;
    this.#shiftsM = NO_SHIFTS;
    this.scaleTo(calibration.statureM);
  }

  /** Use the usual offsets of somebody of this stature for whatever was not calibrated. */
  scaleTo(statureM: number): void {
    if (statureM === this.#usualOf) return;
    this.#usualOf = statureM;
    this.#usual = fromDevices(usualOffsets(statureM));
  }

  /**
   * Shift the joints of parts from where their devices say, as an operator ordered: goal -> metres in
   * the axes that the part has in the T-pose.
   */
  shift(shiftsM: Readonly<Record<string, Vector>>): void {
    this.#shiftsM = shiftsM;
  }

  /** The goals of a frame; valid until the next call. */
  goals(frame: TrackedFrame): Goals {
    for (const part of GOAL_PARTS) this.#goals[part] = this.#goal(part, frame);
    return this.#goals;
  }

  #goal(part: GoalPart, { eyes, parts }: TrackedFrame): Place | null {
    const { place, device } = parts[trackedBy(part, this.#calibration ?? NOT_SWAPPED)];
    // The eyes of a source that moves joints are behind its head's.
    const tracker = part === "Head" && device === "headset" ? eyes : place;
    if (tracker === null || device === null) return null;
    const goal = composed(tracker, this.#offset(part, device));
    const shiftM = this.#shiftsM[part];
    if (shiftM === undefined) return goal;
    return { ...goal, positionM: plus(goal.positionM, rotate(goal.rotation, shiftM)) };
  }

  #offset(part: GoalPart, device: TrackingDevice): Place {
    // These are joints already.
    if (device === "joint" || device === "hand") return AT_ORIGIN;
    const calibrated = this.#calibration?.offsets[part];
    if (calibrated !== undefined && calibrated.device === device) return calibrated.trackerFromGoal;
    return device === "body" ? AT_ORIGIN : this.#usual[part];
  }
}

/** device_from_joint of every part. */
function fromDevices(offsets: WornOffsets): Readonly<Record<GoalPart, Place>> {
  const { Hips, Head, LeftHand, RightHand, LeftLowerLeg, RightLowerLeg } = offsets;
  return {
    Hips: inverted(Hips),
    Head: inverted(Head),
    LeftHand: inverted(LeftHand),
    RightHand: inverted(RightHand),
    LeftLowerLeg: inverted(LeftLowerLeg),
    RightLowerLeg: inverted(RightLowerLeg),
  };
}
