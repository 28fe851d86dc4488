/** Numbers that are collected once a frame and asked for their percentiles at the end. */

/** Enough for two minutes at 120 Hz; more makes it grow. */
const USUAL = 16_384;

export class Samples {
  #values = new Float64Array(USUAL);
  #count = 0;
  #sum = 0;

  add(value: number): void {
    if (this.#count === this.#values.length) {
      const grown = new Float64Array(2 * this.#count);
      grown.set(this.#values);
      this.#values = grown;
    }
    this.#values[this.#count] = value;
    this.#count += 1;
    this.#sum += value;
  }

  get count(): number {
    return this.#count;
  }

  get sum(): number {
    return this.#sum;
  }

  /** How many samples are larger than this. */
  countAbove(limit: number): number {
    return this.#values.subarray(0, this.#count).reduce((n, value) => n + Number(value > limit), 0);
  }

  /**
   * The percentiles at these shares (0 to 1), on the straight line between the two samples beside
   * each (Hyndman and Fan 1996, definition 7, NumPy's default). 0 for each without samples.
   */
  percentiles<Shares extends readonly number[]>(
    ...shares: Shares
  ): { readonly [At in keyof Shares]: number } {
    const sorted = this.#values.slice(0, this.#count).sort();
    const at = (share: number): number => {
      if (sorted.length === 0) return 0;
      const place = share * (sorted.length - 1);
      const below = Math.floor(place);
      const low = sorted[below] as number;
      const high = sorted[Math.min(below + 1, sorted.length - 1)] as number;
      // Rounding must not lead past the upper one: percentiles never descend.
      return Math.min(high, low + (place - below) * (high - low));
    };
    return shares.map(at) as { readonly [At in keyof Shares]: number };
  }
}
