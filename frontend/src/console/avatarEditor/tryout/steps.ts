/**
 * What a step response amounts to: the figures of the server's
 * `app/science/avatar/tuning/step_response.py` (vectors: `responses.json`), and where in a stream of
 * readings a step begins and ends.
 */
import { TICK_S } from "./physics/triedBody";

const DEGREES = 180 / Math.PI;
const SETTLED_SHARE = 0.02;
/** The final angle is the mean over this time at the end. */
const REST_S = 0.05;

export interface StepFigures {
  /** From the angle at which the axis was when the target jumped, to the target. */
  readonly stepDeg: number;
  /** The farthest excursion beyond the final angle, % of the distance travelled. */
  readonly overshootPercent: number;
  /** Time until the angle stays within 2 % of the distance; null if it does not. */
  readonly settlingS: number | null;
  /** Time from 10 to 90 % of the distance; null if the axis does not get there. */
  readonly riseS: number | null;
  /** Target minus final angle. */
  readonly steadyErrorDeg: number;
}

/**
 * Return the figures of a step from the angles (radians) after each `stepS` since the target jumped.
 * All shares are of the distance from the first angle to where the axis comes to rest: gravity,
 * under which a spring must give way, counts as steady error and not as overshoot.
 */
export function stepFigures(
  anglesRad: Float64Array,
  startRad: number,
  targetRad: number,
  stepS: number,
): StepFigures {
  const count = anglesRad.length;
  const tail = Math.min(Math.max(Math.round(REST_S / stepS), 1), count);
  const rest = anglesRad.subarray(count - tail).reduce((sum, one) => sum + one, 0) / tail;
  const distance = rest - startRad;
  const stepDeg = DEGREES * (targetRad - startRad);
  if (!anglesRad.every(Number.isFinite) || distance === 0) {
    const nowhere = { overshootPercent: 100, settlingS: null, riseS: null };
    return { stepDeg, ...nowhere, steadyErrorDeg: stepDeg };
  }
  const shares = anglesRad.map((angle) => (angle - startRad) / distance);
  const settledAt = shares.findLastIndex((share) => Math.abs(share - 1) > SETTLED_SHARE) + 1;
  const low = shares.findIndex((share) => share >= 0.1);
  const high = shares.findIndex((share) => share >= 0.9);
  return {
    stepDeg,
    overshootPercent: 100 * Math.max(Math.max(...shares) - 1, 0),
    // An axis that is outside in the time that defines its final angle has not settled.
    settlingS: settledAt < count - tail ? (settledAt + 1) * stepS : null,
    riseS: low < 0 || high < 0 ? null : (high - low) * stepS,
    steadyErrorDeg: DEGREES * (targetRad - rest),
  };
}

/** The figures of a step on the page, and for how long it has been watched. */
export interface WatchedStep extends StepFigures {
  /** The angle by which the target jumped from the target before it. */
  readonly orderedDeg: number;
  readonly watchedS: number;
}

/** Smaller jumps are no steps: a target may drift. */
const SMALLEST_RAD = 0.5 / DEGREES;
const STILL_RAD = 1e-6;
/** A target that is still for less than this is a movement, not a step. */
const SHORTEST = Math.round(0.25 / TICK_S);
/** From then on a step that still lasts replaces the one before it. */
const SHOWN_FROM = Math.round(1 / TICK_S);
const LONGEST = Math.round(10 / TICK_S);

/** Finds the steps in the readings of an axis: its target jumps, and stands still. */
export class StepWatch {
  private readonly angles = new Float64Array(LONGEST);
  private count = 0;
  private startRad: number | null = null;
  private targetRad = Number.NaN;
  private orderedDeg = 0;
  private lastAngleRad: number | null = null;
  private before: WatchedStep | null = null;

  /** Take the target and the angle of the next tick. */
  add(targetRad: number, angleRad: number): void {
    if (!(Math.abs(targetRad - this.targetRad) <= STILL_RAD)) {
      this.before = this.figuresFrom(SHORTEST) ?? this.before;
      const isStep = Math.abs(targetRad - this.targetRad) >= SMALLEST_RAD;
      this.startRad = isStep ? this.lastAngleRad : null;
      this.orderedDeg = DEGREES * (targetRad - this.targetRad);
      this.targetRad = targetRad;
      this.count = 0;
    }
    if (this.count < LONGEST) this.angles[this.count++] = angleRad;
    this.lastAngleRad = angleRad;
  }

  /** What follows was disturbed: it no longer belongs to the step. */
  disturb(): void {
    this.before = this.figuresFrom(SHORTEST) ?? this.before;
    this.startRad = null;
  }

  /** What was before says nothing about what follows. */
  forget(): void {
    this.before = null;
    this.startRad = null;
    this.lastAngleRad = null;
    this.targetRad = Number.NaN;
  }

  /** The step that has lasted for a second, else the one before it; null if there was none. */
  get figures(): WatchedStep | null {
    return this.figuresFrom(this.before === null ? SHORTEST : SHOWN_FROM) ?? this.before;
  }

  private figuresFrom(least: number): WatchedStep | null {
    const { startRad, count, targetRad } = this;
    if (startRad === null || count < least) return null;
    const angles = this.angles.subarray(0, count);
    return {
      ...stepFigures(angles, startRad, targetRad, TICK_S),
      orderedDeg: this.orderedDeg,
      watchedS: count * TICK_S,
    };
  }
}
