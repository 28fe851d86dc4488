/**
 * The joints of every pose that is shown, and the skeleton of somebody whose body is not loaded yet.
 */
import { BODY } from "@shared/bodyJoints";
import { withFingers, writeFingers } from "@shared/stage/fingers";
import type { BodyBinding } from "@shared/stage/skin/pose";
import { restOf, JOINTS as STREAMED } from "../tracking/skeleton";

const NAMES = Object.keys(BODY);
/** The 22 joints of the streams, with their parents' indices (-1 for the hips). */
export const JOINTS = {
  joints: NAMES,
  parents: NAMES.map((name) => NAMES.indexOf(BODY[name] ?? "")),
} as const;

/** Root position, then 22 rotations. */
export const POSE_VALUES = 3 + 4 * NAMES.length;

/** The 22 joints and the 30 parts of fingers. */
export const POSE = withFingers(JOINTS.joints, JOINTS.parents);

/** Numbers of a pose with fingers. */
export const WHOLE_VALUES = 3 + 4 * POSE.joints.length;

/** Write a frame's pose and fingers as one; fingers that are not known are straight. */
export function writePose(
  pose: ArrayLike<number>,
  fingers: ArrayLike<number> | null,
  into: Float32Array,
): void {
  for (let at = 0; at < POSE_VALUES; at++) into[at] = pose[at] ?? Number.NaN;
  writeFingers(fingers ?? NONE, 0, into, POSE_VALUES);
}
const NONE: readonly number[] = [];

/** What is needed of a body to place its parts. */
export type Skeleton = Pick<BodyBinding, "stature_m" | "parts" | "parents" | "joints_m">;

/**
 * The product's skeleton, 1 m tall: to be scaled to a stature. With `armStretch` upper arms and
 * forearms are longer or shorter by this factor.
 */
export const unitSkeleton = (armStretch = 1): Skeleton => ({
  stature_m: 1,
  parts: JOINTS.joints,
  parents: JOINTS.parents,
  joints_m: STREAMED.map((name) => [...restOf(name, armStretch)]),
});

export const UNIT_SKELETON: Skeleton = unitSkeleton();

/** The T-pose on the start square of somebody whose hips' joint is this high, metres. */
export function tPose(hipsHeightM: number): Float32Array {
  const pose = new Float32Array(POSE_VALUES);
  pose[1] = hipsHeightM;
  for (let joint = 0; joint < NAMES.length; joint++) pose[3 + 4 * joint] = 1;
  return pose;
}
