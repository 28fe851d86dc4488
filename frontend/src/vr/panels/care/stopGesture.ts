/**
 * The participant stops at any time, without a button to find: one hand held above the head, or both
 * grips squeezed, for one second.
 *
 * The boxes' targets hang above the hands, not above the head, and a reach over the head is over
 * sooner; so the hand has to be clearly higher than the eyes, and to stay there. Lowering it in time
 * takes it back. After a stop the hands have to come down before another one counts.
 */
import type { TrackedFrame } from "../../tracking/tracked";

export const HOLD_S = 1;

/** About the crown of the head of somebody tall: the wrist of a raised hand is above it. */
const ABOVE_EYES_M = 0.18;

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

export class StopGesture {
  #by: StopBy | null = null;
  #sinceS = 0;
  #seenS = 0;
  #hasStopped = false;

  /**
   * Look at one frame. Returns how far a stop has come; null while nothing is to be shown. `share`
   * is 1 in exactly one frame of a gesture.
   */
  update(frame: TrackedFrame): StopProgress | null {
    const { timeS } = frame;
    const by = gestureIn(frame, this.#by);
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
    if (this.#by === null || this.#hasStopped) return null;
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

function gestureIn(frame: TrackedFrame, before: StopBy | null): StopBy | null {
  const { left, right } = frame.hands;
  const squeezed = left.isSqueezing && right.isSqueezing;
  const areGrips = left.holdsController && right.holdsController;
  // A gesture that has begun goes on, even if the other one begins as well.
  if (before === "grips" && squeezed) return "grips";
  if (isRaised(frame)) return "hand";
  // Fists of tracked hands are too easily made.
  return squeezed && areGrips ? "grips" : null;
}

function isRaised({ eyes, parts }: TrackedFrame): boolean {
  if (eyes === null) return false;
  const limit = eyes.positionM[1] + ABOVE_EYES_M;
  return [parts.LeftHand, parts.RightHand].some(
    ({ place, state }) => state === "tracked" && place !== null && place.positionM[1] > limit,
  );
}
