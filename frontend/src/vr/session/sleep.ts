/**
 * Notices that nobody wears the headset, or that it slept: from gaps between its own frames, and
 * from a head that does not move at all.
 *
 * Headsets announce neither reliably. Some stop calling frames, some end the session, and some keep
 * both going with the display off, with the same pose in every frame. A worn head never holds still
 * to the last bit: its pose is measured, and measurements have noise.
 */
import type { Place } from "@shared/avatar/hips";

/** A gap this long between two frames is sleep, not a slow frame, s. */
export const GAP_S = 0.5;
/** A pose that stays the same for this long is one that nobody measures, s. */
export const STILL_S = 2.0;

/** `gap`: the device slept since the last frame. `still`: it sleeps now, though frames go on. */
export type Sleep = "gap" | "still";

export class SleepWatch {
  #lastS: number | null = null;
  #stillSinceS = 0;
  #isStill = false;
  readonly #pose = new Float64Array(7);

  /** The time of the last frame; null before the first. */
  get lastS(): number | null {
    return this.#lastS;
  }

  /** Whether frames go on with a head that nobody measures. */
  get isStill(): boolean {
    return this.#isStill;
  }

  /** Note a frame; returns what it reveals, and `still` only once. `eyes`: null if not measured. */
  frame(timeS: number, eyes: Place | null): Sleep | null {
    const lastS = this.#lastS;
    this.#lastS = timeS;
    if (eyes === null || this.#moved(eyes)) {
      this.#stillSinceS = timeS;
      this.#isStill = false;
    }
    if (lastS !== null && timeS - lastS >= GAP_S) {
      this.#stillSinceS = timeS;
      return "gap";
    }
    if (this.#isStill || timeS - this.#stillSinceS < STILL_S) return null;
    this.#isStill = true;
    return "still";
  }

  #moved({ positionM, rotation }: Place): boolean {
    const pose = this.#pose;
    let moved = false;
    for (let i = 0; i < 7; i++) {
      const value = (i < 3 ? positionM[i] : rotation[i - 3]) as number;
      moved ||= value !== pose[i];
      pose[i] = value;
    }
    return moved;
  }
}
