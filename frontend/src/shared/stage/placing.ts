/** Where the points of a figure are at a time, those that were not seen where they were last. */
import type { Seconds } from "../units";
import type { Figure } from "./figure";
import { hasGaps, seenFrames } from "./gaps";
import { frameAt } from "./motion";

export interface Placing {
  readonly figure: Figure;
  /** x, y, z of every point, metres; NaN where it was never seen. Written anew by `place`. */
  readonly placed: Float32Array;
  /** 1 where a point is seen now. */
  readonly seen: Uint8Array;
  /** To move to a time; the frame that is shown. */
  readonly place: (time: Seconds) => number;
}

export function placing(figure: Figure): Placing {
  const { motion } = figure;
  const points = motion.names.length;
  const [asideX, asideZ] = figure.aside ?? [0, 0];
  const from = hasGaps(motion) ? seenFrames(motion) : null;
  const placed = new Float32Array(3 * points).fill(Number.NaN);
  const seen = new Uint8Array(points).fill(1);
  const place = (time: Seconds): number => {
    const frame = frameAt(motion, time);
    for (let point = 0; point < points; point++) {
      const taken = from === null ? frame : (from[frame * points + point] ?? -1);
      seen[point] = taken === frame ? 1 : 0;
      const at = 3 * (taken * points + point);
      placed[3 * point] = taken < 0 ? Number.NaN : (motion.positions[at] ?? 0) + asideX;
      placed[3 * point + 1] = taken < 0 ? Number.NaN : (motion.positions[at + 1] ?? 0);
      placed[3 * point + 2] = taken < 0 ? Number.NaN : (motion.positions[at + 2] ?? 0) + asideZ;
    }
    return frame;
  };
  return { figure, placed, seen, place };
}
