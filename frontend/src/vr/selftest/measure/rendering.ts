/** How regularly frames come: from the times of the render loop's own frames. */
import type { Report } from "../report";
import { Samples } from "./samples";

/** A frame that comes later than so many nominal intervals after the one before was missed. */
const LATE_INTERVALS = 1.5;
/** The device's rate as it says is a rounded one, and the times of frames are rounded, too. */
const ROUNDING_S = 1e-9;

type RenderingFigures = Report["rendering"];

export class FrameTimes {
  readonly #intervalsS = new Samples();
  #firstS: number | null = null;
  #lastS = 0;

  /** Note a frame by its time on the page's clock, s. */
  note(timeS: number): void {
    if (this.#firstS === null) this.#firstS = timeS;
    else this.#intervalsS.add(timeS - this.#lastS);
    this.#lastS = timeS;
  }

  /** Frames so far. */
  get frames(): number {
    return this.#firstS === null ? 0 : this.#intervalsS.count + 1;
  }

  /** From the first frame to the newest, s. */
  get durationS(): number {
    return this.#firstS === null ? 0 : this.#lastS - this.#firstS;
  }

  /**
   * The figures of the report. `nominalHz`: the rate that the device says it runs at; null if it
   * does not tell, and then nobody knows which frames were late.
   */
  figures(mode: RenderingFigures["mode"], nominalHz: number | null): RenderingFigures {
    const [p50, p95, p99, longest] = this.#intervalsS.percentiles(0.5, 0.95, 0.99, 1);
    return {
      mode,
      nominal_rate_hz: nominalHz,
      frames: this.frames,
      mean_rate_hz: this.durationS > 0 ? this.#intervalsS.count / this.durationS : 0,
      interval_p50_s: p50,
      interval_p95_s: p95,
      interval_p99_s: p99,
      interval_longest_s: longest,
      late_frames:
        nominalHz === null
          ? null
          : this.#intervalsS.countAbove(LATE_INTERVALS / nominalHz + ROUNDING_S),
    };
  }
}
