/**
 * Rows of local rotations, later: the server's `app/science/delay.py`.
 *
 * At time t a row is what it was at t - delay, by slerp between the two samples around that time;
 * before the first sample it is the first. Row 0, the hips, is never delayed, and a delay of zero
 * gives the pushed values to the bit. The samples lie in one block of memory that is made once.
 */
import { slerpRows } from "./numbers";

const LONGEST_S = 2;
/** Enough for two seconds at 120 Hz, with some spare. */
const CAPACITY = 256;
const HIPS_VALUES = 4;

export class DelayBuffer {
  private delayS = 0;
  private readonly times = new Float64Array(CAPACITY);
  private readonly samples: Float64Array;
  private readonly result: Float64Array;
  private first = 0;
  private count = 0;

  /** `values`: of one sample, four for every rotation. */
  constructor(private readonly values: number) {
    this.samples = new Float64Array(CAPACITY * values);
    this.result = new Float64Array(values);
  }

  setDelay(delayS: number): void {
    if (!(delayS >= 0 && delayS <= LONGEST_S)) {
      throw new Error(`A delay of ${delayS} s is not possible: give 0 to ${LONGEST_S} s.`);
    }
    this.delayS = delayS;
  }

  clear(): void {
    this.first = 0;
    this.count = 0;
  }

  /** Add the rotations of this frame, later than the last one's; return the delayed ones. */
  push(timeS: number, rotations: Float64Array): Float64Array {
    if (this.count > 0 && !(timeS > (this.times[this.at(this.count - 1)] as number))) {
      throw new Error(`The time ${timeS} s is not later than the last frame's.`);
    }
    if (this.count === CAPACITY) this.forgetOne();
    const row = this.at(this.count);
    this.times[row] = timeS;
    this.samples.set(rotations, row * this.values);
    this.count += 1;
    const oldestS = timeS - LONGEST_S;
    // One sample at or before the oldest possible query must stay, to interpolate from.
    while (this.count > 2 && (this.times[this.at(1)] as number) <= oldestS) this.forgetOne();
    if (this.delayS === 0) this.result.set(rotations);
    else {
      this.sample(timeS - this.delayS);
      for (let i = 0; i < HIPS_VALUES; i++) this.result[i] = rotations[i] as number;
    }
    return this.result;
  }

  private sample(timeS: number): void {
    let high = this.count - 1;
    while (high > 0 && (this.times[this.at(high - 1)] as number) >= timeS) high -= 1;
    const upper = this.at(high);
    const to = upper * this.values;
    if (high === 0 || this.times[upper] === timeS) {
      this.result.set(this.samples.subarray(to, to + this.values));
      return;
    }
    const lower = this.at(high - 1);
    const from = lower * this.values;
    const lowS = this.times[lower] as number;
    const fraction = (timeS - lowS) / ((this.times[upper] as number) - lowS);
    for (let i = 0; i < this.values; i += 4) {
      slerpRows(this.samples, from + i, this.samples, to + i, fraction, this.result, i);
    }
  }

  private forgetOne(): void {
    this.first = (this.first + 1) % CAPACITY;
    this.count -= 1;
  }

  private at = (index: number): number => (this.first + index) % CAPACITY;
}
