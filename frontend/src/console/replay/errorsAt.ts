/** How far each joint is from what it was asked for, at a moment. */
import type { JointErrors } from "@shared/api/replays";

export interface JointError {
  readonly joint: string;
  /** Null where nothing can be said. */
  readonly degrees: number | null;
}

export const NO_ERRORS: JointErrors = {
  joints: [],
  frames: 0,
  rateHz: 1,
  values: new Float32Array(),
};

export function errorsAt({ joints, frames, rateHz, values }: JointErrors, time: number) {
  const frame = Math.min(Math.max(Math.round(time * rateHz), 0), frames - 1);
  return joints.map((joint, at): JointError => {
    const radians = frame < 0 ? Number.NaN : (values[frame * joints.length + at] ?? Number.NaN);
    return { joint, degrees: Number.isNaN(radians) ? null : (radians * 180) / Math.PI };
  });
}

/** What is smaller cannot be told from none. */
export const LEAST_DEG = 0.05;

export const largest = (errors: readonly JointError[], count: number): readonly JointError[] =>
  [...errors]
    .filter(({ degrees }) => degrees !== null && degrees >= LEAST_DEG)
    .sort((one, other) => (other.degrees ?? 0) - (one.degrees ?? 0))
    .slice(0, count);

/** Over all joints: the root of the mean square; null where none is known. */
export function overall(errors: readonly JointError[]): number | null {
  const known = errors.flatMap(({ degrees }) => degrees ?? []);
  if (known.length === 0) return null;
  return Math.sqrt(known.reduce((sum, value) => sum + value * value, 0) / known.length);
}
