/**
 * The participant stops at any time, without a button to find: one hand held above the head, or both
 * grips squeezed, for one second.
 *
 * The boxes' targets usually hang above the hands, not above the head, and a reach over the head is
 * over sooner; so the hand has to be clearly higher than the eyes, and to stay there. At boxes as high
 * as that, both hands have to be raised. Lowering them in time takes it back. After a stop the hands
 * have to come down before another one counts.
 */
import type { TrackedFrame, TrackedPart } from "../../tracking/tracked";

export const HOLD_S = 1;

/** About the crown of the head of somebody tall: the wrist of a raised hand is above it. */
const ABOVE_EYES_M = 0.18;

/** Boxes whose upper end is this far above the eyes are reached with a hand that looks raised. */
const HIGH_M = 0.1;

/** Whether boxes that reach up to `highestM` make somebody raise a hand as high as a stop does. */
export const looksRaised = (highestM: number, eyesHeightM: number): boolean =>
  highestM > eyesHeightM + HIGH_M;

/** A hand that is not seen for so long, as when it leaves the cameras' view, does not count as lowered. */
const GRACE_S = 0.15;

/** What is shown begins a little after the gesture, so that a short reach shows nothing. */
const SHOWN_AFTER_S = 0.25;

export type StopBy = "hand" | "grips";

export interface StopProgress {
  /** From 0 to 1; at 1 the participant has stopped. */
  readonly share: number;
  readonly by: StopBy;
}

/** What the moment allows. */
export interface StopRules {
  /** Nothing stops now: both grips mean something else, or there is nothing to stop. */
  readonly isOff?: boolean;
  /** One raised hand is part of what the participant does: only both together stop. */
  readonly needsBothHands?: boolean;
}

export class StopGesture {
  #by: StopBy | null = null;
  #sinceS = 0;
  #seenS = 0;
  #hasStopped = false;

  /**
   * Look at one frame. Returns how far a stop has come; null while nothing is to be shown. `share`
   * is 1 in exactly one frame of a gesture.
   */
  update(frame: TrackedFrame, { isOff = false, needsBothHands = false }: StopRules = {}) {
    const { timeS } = frame;
    const by = gestureIn(frame, this.#by, needsBothHands);
    if (isOff) {
      // What was held meanwhile, as the grips are to enter the body, has to be let go first.
      this.#by = by;
      this.#seenS = timeS;
      this.#hasStopped = by !== null;
      return null;
    }
    if (by === null) {
      if (this.#by !== null && timeS - this.#seenS > GRACE_S) this.#reset();
      if (this.#by === null) this.#hasStopped = false;
    } else {
      if (this.#by !== by) {
        this.#by = by;
        this.#sinceS = timeS;
      }
      this.#seenS = timeS;
    }
    return this.#hasStopped ? null : this.#progress(timeS, by);
  }

  #progress(timeS: number, by: StopBy | null): StopProgress | null {
    if (this.#by === null) return null;
    const heldS = timeS - this.#sinceS;
    if (heldS >= HOLD_S && by !== null) {
      this.#hasStopped = true;
      return { share: 1, by };
    }
    return heldS < SHOWN_AFTER_S ? null : { share: Math.min(heldS / HOLD_S, 0.99), by: this.#by };
  }

  #reset(): void {
    this.#by = null;
  }
}

function gestureIn(
  frame: TrackedFrame,
  before: StopBy | null,
  needsBothHands: boolean,
): StopBy | null {
  const { left, right } = frame.hands;
  const squeezed = left.isSqueezing && right.isSqueezing;
  const areGrips = left.holdsController && right.holdsController;
  // A gesture that has begun goes on, even if the other one begins as well.
  if (before === "grips" && squeezed) return "grips";
  if (isRaised(frame, needsBothHands)) return "hand";
  // Fists of tracked hands are too easily made.
  return squeezed && areGrips ? "grips" : null;
}

function isRaised({ eyes, parts }: TrackedFrame, needsBothHands: boolean): boolean {
  if (eyes === null) return false;
  const limitM = eyes.positionM[1] + ABOVE_EYES_M;
  const [left, right] = [isAbove(parts.LeftHand, limitM), isAbove(parts.RightHand, limitM)];
  return needsBothHands ? left && right : left || right;
}

const isAbove = ({ place, state }: TrackedPart, heightM: number): boolean =>
  state === "tracked" && place !== null && place.positionM[1] > heightM;
