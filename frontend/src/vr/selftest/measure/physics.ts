/** How fast the bodies are computed, from the results that the page receives. */
import type { BodiesFrame } from "../../bodies";
import type { Report } from "../report";
import { Samples } from "./samples";

/** Longer gaps between two inputs are left out by the simulation instead of being caught up. */
const LONGEST_STEP_S = 0.1;

type PhysicsFigures = NonNullable<Report["physics"]>;
type Computed = Pick<BodiesFrame, "timeS" | "tookMs"> & {
  readonly health: Pick<BodiesFrame["health"], "resets">;
};

export class PhysicsRecord {
  readonly #tookS = new Samples();
  #lastS: number | null = null;
  #simulatedS = 0;
  #firstResets = 0;
  #resets = 0;

  /** Note the newest result; one that was noted before changes nothing. */
  note({ timeS, tookMs, health }: Computed): void {
    if (this.#lastS === null) this.#firstResets = health.resets;
    else {
      const stepS = timeS - this.#lastS;
      if (stepS <= 0) return;
      // A gap is left out, so it tells nothing about how fast the simulation is.
      if (stepS <= LONGEST_STEP_S) {
        this.#tookS.add(tookMs / 1000);
        this.#simulatedS += stepS;
      }
    }
    this.#lastS = timeS;
    this.#resets = health.resets;
  }

  /** The figures of the report; null if nothing was simulated. */
  figures(of: Pick<PhysicsFigures, "model_hash" | "stature_m" | "where">): Report["physics"] {
    if (this.#tookS.count === 0) return null;
    const [p50, p95, p99] = this.#tookS.percentiles(0.5, 0.95, 0.99);
    const tookS = this.#tookS.sum;
    return {
      ...of,
      simulated_s: this.#simulatedS,
      // Clocks of browsers are coarse: what took no time that can be measured took at most a tick.
      real_time_factor: this.#simulatedS / Math.max(tookS, CLOCK_S),
      frame_p50_s: p50,
      frame_p95_s: p95,
      frame_p99_s: p99,
      resets: this.#resets - this.#firstResets,
    };
  }
}

/** The coarsest tick of a browser's clock, s. */
const CLOCK_S = 1e-3;
