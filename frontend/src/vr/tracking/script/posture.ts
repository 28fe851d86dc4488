/**
 * Two-bone limbs by the law of cosines, in world axes: the server's
 * `app/science/simulation/two_bone.py` has the equations.
 */
import {
  cross,
  dot,
  fromAxes,
  length,
  minus,
  type Quaternion,
  times,
  type Vector,
} from "@shared/rotations";
import { across } from "./movements";

const TINY_M = 1e-9;

export interface TwoBone {
  /** Unit directions of the two bones. */
  readonly upper: Vector;
  readonly lower: Vector;
  /** Unit normal of their plane: the direction to the end crossed with the pole's side. */
  readonly normal: Vector;
}

/** Place two bones from a root towards an end, bending towards `pole`; too far: stretched to it. */
export function twoBone(
  rootM: Vector,
  endM: Vector,
  upperM: number,
  lowerM: number,
  pole: Vector,
): TwoBone {
  const line = minus(endM, rootM);
  const distance = length(line);
  const way: Vector = distance < TINY_M ? [0, -1, 0] : times(line, 1 / distance);
  const reach = Math.min(Math.max(distance, Math.abs(upperM - lowerM) + TINY_M), upperM + lowerM);
  const side = across(way, pole);
  const cosine = Math.min(
    1,
    Math.max(-1, (upperM * upperM + reach * reach - lowerM * lowerM) / (2 * upperM * reach)),
  );
  const along = upperM * cosine;
  const out = upperM * Math.sqrt(1 - cosine * cosine);
  const mid: Vector = [
    along * way[0] + out * side[0],
    along * way[1] + out * side[1],
    along * way[2] + out * side[2],
  ];
  const rest = minus(times(way, reach), mid);
  return {
    upper: times(mid, 1 / upperM),
    lower: times(rest, 1 / lowerM),
    normal: cross(way, side),
  };
}

/**
 * world_from_joint of an arm bone along `bone`: in the T-pose the right arm (sign 1) runs along +x,
 * the left (-1) along -x, and both elbows bend about y, forwards.
 */
export function armRotation(bone: Vector, normal: Vector, sign: number): Quaternion {
  const x = times(bone, sign);
  const y = times(normal, -sign);
  return fromAxes(x, y, cross(x, y));
}

/** world_from_hand for fingers along a direction, with the least twist against the arm's plane. */
export function handRotation(fingers: Vector, normal: Vector, sign: number): Quaternion {
  const flat = minus(normal, times(fingers, dot(fingers, normal)));
  const size = length(flat);
  return armRotation(
    fingers,
    size > 1e-6 ? times(flat, 1 / size) : across(fingers, [1, 0, 0]),
    sign,
  );
}

/** world_from_joint of a leg bone: in the T-pose it runs along -y and bends about x. */
export function legRotation(bone: Vector, normal: Vector): Quaternion {
  const y = times(bone, -1);
  return fromAxes(normal, y, cross(normal, y));
}
