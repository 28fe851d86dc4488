/**
 * How a part that is pushed gives way and comes back: the figures of the server's
 * `app/science/avatar/tuning/disturbance.py`, tick by tick (vectors: `responses.json`).
 *
 * Deflection is the angle of the part from its direction just before the push; it has returned when
 * it stays within 2 degrees of that.
 */
import { inverseMultiplyRows } from "@shared/avatar/physics/numbers";
import { TICK_S } from "./triedBody";

export const RETURNED_RAD = (2 * Math.PI) / 180;
/** Time after the end of a push for which the part is watched, as the benchmark's. */
export const WATCHED_AFTER_S = 2.3;
const TICKS_AFTER = Math.round(WATCHED_AFTER_S / TICK_S);

export interface PushFigures {
  readonly part: string;
  readonly peakRad: number;
  /** From the end of the push until it stays within 2 degrees; null where it has not returned. */
  readonly returnS: number | null;
  /** Whether it is being pushed, watched afterwards, or whether these figures are final. */
  readonly phase: "pushed" | "watched" | "over";
  /** Whether the body was at rest before, and nothing but this push moved it since. */
  readonly isAlone: boolean;
}

export class Deflection {
  private readonly before: Float64Array;
  private readonly turn = new Float64Array(4);
  private ticks = 0;
  private pushedTicks = 0;
  /** Ticks until the last one beyond 2 degrees. */
  private beyond = 0;
  private peakRad = 0;
  private isAlone: boolean;

  /** `world_from_part` just before the push begins. */
  constructor(
    readonly part: string,
    worldFromPart: Float64Array,
    isAtRest = true,
  ) {
    this.isAlone = isAtRest;
    this.before = Float64Array.from(worldFromPart);
  }

  /** Note where the part is after a tick, and whether it was pushed in it. */
  turned(worldFromPart: Float64Array, isPushed: boolean): void {
    inverseMultiplyRows(this.before, 0, worldFromPart, 0, this.turn, 0);
    const [w = 1, x = 0, y = 0, z = 0] = this.turn;
    this.note(2 * Math.atan2(Math.hypot(x, y, z), Math.abs(w)), isPushed);
  }

  note(deflectionRad: number, isPushed: boolean): void {
    if (this.isOver) return;
    this.ticks += 1;
    if (isPushed) this.pushedTicks = this.ticks;
    this.peakRad = Math.max(this.peakRad, deflectionRad);
    if (deflectionRad > RETURNED_RAD) this.beyond = this.ticks;
  }

  get figures(): PushFigures {
    const { part, ticks, pushedTicks, beyond, peakRad } = this;
    const returnS = beyond === ticks ? null : Math.max(beyond - pushedTicks, 0) * TICK_S;
    const isPushed = ticks === pushedTicks;
    return {
      part,
      peakRad,
      returnS,
      phase: isPushed ? "pushed" : this.isOver ? "over" : "watched",
      isAlone: this.isAlone,
    };
  }

  /** Something else was done to the body. */
  disturb(): void {
    if (!this.isOver) this.isAlone = false;
  }

  get isOver(): boolean {
    return this.ticks >= this.pushedTicks + TICKS_AFTER;
  }
}
