/** The last seconds of an axis, tick by tick, and what they amount to. Angles in degrees. */
import type { MarkKind } from "./marks";
import { READING } from "./physics/tryout";
import { StepWatch, type WatchedStep } from "./steps";

/** How far back a picture and the figures beside it look. */
export const WINDOW_S = 5;
export const WINDOW_TICKS = 500;
/** The share of its torque limit from which a motor counts as saturated. */
const SATURATED = 0.999;
const DEGREES = 180 / Math.PI;

export const CURVES = ["target", "angle", "error", "torque"] as const;
export type Curve = (typeof CURVES)[number];

/** What the window of one body amounts to; null before the first tick or without a hinge. */
export interface Summary {
  readonly targetDeg: number;
  readonly angleDeg: number;
  readonly errorDeg: number;
  readonly rmsErrorDeg: number;
  readonly greatestErrorDeg: number;
  readonly torqueNm: number;
  /** The motor's torque limit now. */
  readonly limitNm: number;
  /** Share of the time with the motor at its limit. */
  readonly saturated: number;
  readonly isSaturated: boolean;
}

/** A ring of the last ticks of one body. */
export class Trace {
  private readonly rings: Readonly<Record<Curve, Float64Array>> = {
    target: new Float64Array(WINDOW_TICKS),
    angle: new Float64Array(WINDOW_TICKS),
    error: new Float64Array(WINDOW_TICKS),
    torque: new Float64Array(WINDOW_TICKS),
  };
  private readonly saturated = new Uint8Array(WINDOW_TICKS);
  private readonly steps = new StepWatch();
  /** The torque limit of the newest readings, N m. */
  limitNm = Number.NaN;
  private first = 0;
  /** Number of ticks it holds. */
  length = 0;

  /**
   * Add the readings of an advance: target, angle (radians) and torque (N m), tick after tick, of a
   * motor with this torque limit.
   */
  add(readings: Float64Array, limitNm: number): void {
    this.limitNm = limitNm;
    for (let at = 0; at + READING <= readings.length; at += READING) {
      const target = readings[at] as number;
      const angle = readings[at + 1] as number;
      this.steps.add(target, angle);
      this.put(DEGREES * target, DEGREES * angle, readings[at + 2] as number);
    }
  }

  clear(): void {
    this.first = 0;
    this.length = 0;
    this.steps.forget();
  }

  /** Something was done to the body: what follows belongs to no step that began before. */
  disturb(kind: MarkKind): void {
    if (kind === "push" || kind === "pull" || kind === "drop") this.steps.disturb();
    else this.steps.forget();
  }

  /** The figures of the last step; null if there was none. */
  get step(): WatchedStep | null {
    return this.steps.figures;
  }

  /** A value of a curve; 0 is the oldest. */
  at(curve: Curve, index: number): number {
    return this.rings[curve][(this.first + index) % WINDOW_TICKS] as number;
  }

  /** Whether the motor was at its torque limit. */
  isSaturatedAt(index: number): boolean {
    return this.saturated[(this.first + index) % WINDOW_TICKS] === 1;
  }

  /** Summarise the window; null if there is nothing in it. */
  get summary(): Summary | null {
    const last = this.length - 1;
    if (last < 0 || Number.isNaN(this.at("angle", last))) return null;
    let squares = 0;
    let greatest = 0;
    let saturated = 0;
    for (let index = 0; index <= last; index++) {
      const error = this.at("error", index);
      squares += error * error;
      greatest = Math.max(greatest, Math.abs(error));
      if (this.isSaturatedAt(index)) saturated += 1;
    }
    return {
      targetDeg: this.at("target", last),
      angleDeg: this.at("angle", last),
      errorDeg: this.at("error", last),
      rmsErrorDeg: Math.sqrt(squares / this.length),
      greatestErrorDeg: greatest,
      torqueNm: this.at("torque", last),
      limitNm: this.limitNm,
      saturated: saturated / this.length,
      isSaturated: this.isSaturatedAt(last),
    };
  }

  private put(target: number, angle: number, torque: number): void {
    const { rings } = this;
    if (this.length === WINDOW_TICKS) this.first = (this.first + 1) % WINDOW_TICKS;
    else this.length += 1;
    const at = (this.first + this.length - 1) % WINDOW_TICKS;
    rings.target[at] = target;
    rings.angle[at] = angle;
    rings.error[at] = target - angle;
    rings.torque[at] = torque;
    const { limitNm } = this;
    this.saturated[at] = limitNm > 0 && Math.abs(torque) >= SATURATED * limitNm ? 1 : 0;
  }
}
