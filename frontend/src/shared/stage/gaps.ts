/** Where points were not seen, and where they were seen last. */
import type { PointMotion } from "./motion";

const unseen = (motion: PointMotion, index: number): boolean =>
  Number.isNaN(motion.positions[3 * index] ?? Number.NaN);

export const hasGaps = (motion: PointMotion): boolean => {
  const { positions } = motion;
  for (let at = 0; at < positions.length; at += 3) {
    if (Number.isNaN(positions[at] ?? Number.NaN)) return true;
  }
  return false;
};

/**
 * The frame to take each point of each frame from: itself where it was seen, else the last one in
 * which it was, else the next one, else -1. Laid out as [frame][point].
 */
export function seenFrames(motion: PointMotion): Int32Array {
  const points = motion.names.length;
  const from = new Int32Array(motion.frames * points).fill(-1);
  for (let point = 0; point < points; point++) {
    let last = -1;
    for (let frame = 0; frame < motion.frames; frame++) {
      const index = frame * points + point;
      if (!unseen(motion, index)) {
        // What comes before the first sight is shown where it will appear.
        if (last < 0)
          for (let early = 0; early < frame; early++) from[early * points + point] = frame;
        last = frame;
      }
      if (last >= 0) from[index] = last;
    }
  }
  return from;
}

/** A stretch of frames with the same share of points unseen; `to` is the frame after the last. */
export interface Stretch {
  readonly from: number;
  readonly to: number;
  readonly share: number;
}

/** Stretches in which something was not seen, told in at most `bins` parts of the movement. */
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
