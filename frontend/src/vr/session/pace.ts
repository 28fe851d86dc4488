/** Notices a device that draws so few pictures that the session's clock cannot run on it. */
import { GAP_S } from "./sleep";

/** Pictures a second below which every interval counts as sleep, and the clock stands still. */
export const LEAST_RATE_HZ = 1 / GAP_S;
/** A gap of this length is a window in the background or a device asleep, not a slow one, s. */
const SLEEP_S = 10;
const INTERVALS = 5;
/** So many of them tell a slow device from one that stumbles once. */
const SLOW_INTERVALS = 4;

export class Pace {
  #lastS: number | null = null;
  #intervalsS: readonly number[] = [];

  /** Note a picture; returns the pictures a second if they are too few, else null. */
  note(timeS: number): number | null {
    const intervalS = this.#lastS === null ? null : timeS - this.#lastS;
    this.#lastS = timeS;
    if (intervalS === null) return null;
    this.#intervalsS = [...this.#intervalsS, intervalS].slice(-INTERVALS);
    const slow = this.#intervalsS.filter((one) => one >= GAP_S && one < SLEEP_S);
    if (slow.length < SLOW_INTERVALS) return null;
    return slow.length / slow.reduce((sum, one) => sum + one, 0);
  }
}
