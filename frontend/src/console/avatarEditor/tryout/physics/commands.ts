/**
 * What is done to a body that is tried: one joint is driven or a capture played, a part is pushed.
 *
 * Time is the simulation's own, seconds since the last reset, so that bodies side by side are given
 * exactly the same, also when one of them has joined later.
 */

/** How an angle changes over time; radians from the T-pose. */
export type Wave =
  | { readonly kind: "hold"; readonly angleRad: number }
  | {
      readonly kind: "step" | "sine";
      readonly centerRad: number;
      readonly amplitudeRad: number;
      readonly periodS: number;
    };

/**
 * The angle of a wave at a time. A step is at `center - amplitude` in the first half of each period
 * and at `center + amplitude` in the second; a sine begins at its centre, upwards.
 */
export function waveAt(wave: Wave, timeS: number): number {
  if (wave.kind === "hold") return wave.angleRad;
  const turn = timeS / wave.periodS - Math.floor(timeS / wave.periodS);
  const share = wave.kind === "step" ? (turn < 0.5 ? -1 : 1) : Math.sin(2 * Math.PI * turn);
  return wave.centerRad + share * wave.amplitudeRad;
}

export interface Drive {
  readonly axis: string;
  readonly wave: Wave;
}

/**
 * A force on a point of a part, in newtons along the world's axes. It is computed anew from the
 * part's place every 10 ms, and acts for `forS` from then on, or until the next push for null.
 */
export interface Push {
  readonly part: string;
  /** Where it acts, in the part's own frame; null for its centre of mass. */
  readonly pointM: Vector | null;
  readonly forceN: Vector;
  readonly forS: number | null;
}

export type Vector = readonly [x: number, y: number, z: number];

/** A captured movement: hips (3) and local rotations (22 x 4) by frame; it plays again and again. */
export interface Capture {
  readonly rateHz: number;
  readonly frames: number;
  readonly hipsM: Float64Array;
  readonly rotations: Float64Array;
}

/** The frame of a capture at a time: the last one that has begun. */
export const frameAt = ({ rateHz, frames }: Capture, timeS: number): number =>
  Math.floor(timeS * rateHz + 1e-6) % frames;

/** What holds from the next 10 ms on. */
export type Command =
  | { readonly kind: "drive"; readonly drive: Drive | null }
  /** The angles of the axes that are not driven, radians; zero where none is given. */
  | { readonly kind: "pose"; readonly anglesRad: Readonly<Record<string, number>> }
  | { readonly kind: "play"; readonly capture: Capture }
  | { readonly kind: "push"; readonly push: Push | null }
  | { readonly kind: "latency"; readonly latencyS: number }
  | { readonly kind: "gravity"; readonly isOn: boolean }
  /** The middle of the box, in the world. */
  | { readonly kind: "drop"; readonly centerM: Vector }
  /** Begin anew at rest in the commanded pose; at time zero, or at that of another body. */
  | { readonly kind: "reset"; readonly atTick?: number };
