/** What a person sees in the first person: from the pose of the head, as a headset shows it. */
import {
  multiply,
  normalised,
  plus,
  type Quaternion,
  rotate,
  times,
  type Vector,
} from "../rotations";
import type { PointMotion } from "./motion";

/** Where a camera is and what it looks at, metres in the world. */
export interface Sight {
  readonly fromM: Vector;
  readonly toM: Vector;
}

/** From the top of the neck, where the head's joint is, to between the eyes. */
const UP_M = 0.09;
const AHEAD_M = 0.1;
/** Tilted down a little, like a headset's picture: boxes and hands are below the horizon. */
const DOWN = 0.55;

/** The sight of a head; null if its pose is unknown. */
export function sightOf(headM: Vector, worldFromHead: Quaternion): Sight | null {
  const ahead = rotate(worldFromHead, [0, 0, -1]);
  const up = rotate(worldFromHead, [0, 1, 0]);
  const fromM = plus(plus(headM, times(up, UP_M)), times(ahead, AHEAD_M));
  if (!fromM.every(Number.isFinite)) return null;
  return { fromM, toM: plus(fromM, plus(ahead, times(up, -DOWN))) };
}

/** The sight of a body's head at a frame of its movement; null where its rotation is unknown. */
export function sightAt(motion: PointMotion, frame: number): Sight | null {
  const { rotations, positions, parents, names } = motion;
  const head = names.indexOf("Head");
  if (rotations === undefined || head < 0) return null;
  let worldFromHead: Quaternion = [1, 0, 0, 0];
  for (let joint = head; joint >= 0; joint = parents[joint] ?? -1) {
    const from = 4 * (frame * names.length + joint);
    const [w = 0, x = 0, y = 0, z = 0] = rotations.subarray(from, from + 4);
    worldFromHead = multiply(normalised([w, x, y, z]), worldFromHead);
  }
  const from = 3 * (frame * names.length + head);
  const [x = Number.NaN, y = Number.NaN, z = Number.NaN] = positions.subarray(from, from + 3);
  return sightOf([x, y, z], worldFromHead);
}
