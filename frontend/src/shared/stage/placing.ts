/** Place the points of a figure at a time; unseen points stay where they were last seen. */
import type { Seconds } from "../units";
import type { Figure } from "./figure";
import { frameAt, type PointMotion } from "./motion";

export interface Placing {
  readonly figure: Figure;
  /** x, y, z of every point, metres; NaN if it was never seen. Overwritten by `place`. */
  readonly placed: Float32Array;
  /** 1 for a point that is seen now. */
  readonly seen: Uint8Array;
  /** Move to a time; return the frame that is shown. */
  readonly place: (time: Seconds) => number;
}

export function placing(figure: Figure): Placing {
  const { motion } = figure;
  const points = motion.names.length;
  const [asideX, asideZ] = figure.offset ?? [0, 0];
  const from = hasGaps(motion) ? seenFrames(motion) : null;
  const placed = new Float32Array(3 * points).fill(Number.NaN);
  const seen = new Uint8Array(points).fill(1);
  const place = (time: Seconds): number => {
    const frame = frameAt(motion, time);
    for (let point = 0; point < points; point++) {
      const source = from === null ? frame : (from[frame * points + point] ?? -1);
      seen[point] = source === frame ? 1 : 0;
      const at = 3 * (source * points + point);
      placed[3 * point] = source < 0 ? Number.NaN : (motion.positions[at] ?? 0) + asideX;
      placed[3 * point + 1] = source < 0 ? Number.NaN : (motion.positions[at + 1] ?? 0);
      placed[3 * point + 2] = source < 0 ? Number.NaN : (motion.positions[at + 2] ?? 0) + asideZ;
    }
    return frame;
  };
  return { figure, placed, seen, place };
}

const unseen = (motion: PointMotion, index: number): boolean =>
  Number.isNaN(motion.positions[3 * index] ?? Number.NaN);

/** Whether any point is unseen in any frame. */
export const hasGaps = (motion: PointMotion): boolean => {
  const { positions } = motion;
  for (let at = 0; at < positions.length; at += 3) {
    if (Number.isNaN(positions[at] ?? Number.NaN)) return true;
  }
  return false;
};

/**
 * The frame to take each point of each frame from: the frame itself if the point was seen in it,
 * otherwise the last one before, otherwise the next one, otherwise -1. Laid out as [frame][point].
 */
export function seenFrames(motion: PointMotion): Int32Array {
  const points = motion.names.length;
  const from = new Int32Array(motion.frames * points).fill(-1);
  for (let point = 0; point < points; point++) {
    let last = -1;
    for (let frame = 0; frame < motion.frames; frame++) {
      const index = frame * points + point;
      if (!unseen(motion, index)) {
        // Before a point is first seen, it is shown where it will appear.
        if (last < 0)
          for (let early = 0; early < frame; early++) from[early * points + point] = frame;
        last = frame;
      }
      if (last >= 0) from[index] = last;
    }
  }
  return from;
}

/** An interval of frames with the same share of unseen points; `to` is the frame after the last. */
interface Stretch {
  readonly from: number;
  readonly to: number;
  readonly share: number;
}

/** Intervals with unseen points, at a resolution of at most `bins` parts of the movement. */
export function gapStretches(motion: PointMotion, bins = 480): readonly Stretch[] {
  const points = motion.names.length;
  const wide = Math.max(1, Math.ceil(motion.frames / bins));
  const stretches: Stretch[] = [];
  for (let from = 0; from < motion.frames; from += wide) {
    const to = Math.min(from + wide, motion.frames);
    let most = 0;
    for (let frame = from; frame < to; frame++) most = Math.max(most, unseenIn(motion, frame));
    const share = most / points;
    const before = stretches.at(-1);
    if (share === 0) continue;
    if (before?.to === from && before.share === share)
      stretches[stretches.length - 1] = { ...before, to };
    else stretches.push({ from, to, share });
  }
  return stretches;
}

function unseenIn(motion: PointMotion, frame: number): number {
  const points = motion.names.length;
  let count = 0;
  for (let point = 0; point < points; point++) {
    if (unseen(motion, frame * points + point)) count++;
  }
  return count;
}

/** The names of the points that were not seen in a frame. */
export const unseenNames = (motion: PointMotion, frame: number): readonly string[] =>
  motion.names.filter((_, point) => unseen(motion, frame * motion.names.length + point));
