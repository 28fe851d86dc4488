/**
 * The joints of every pose that is shown, and the skeleton of somebody whose body is not loaded yet.
 */
import { BODY } from "@shared/avatar/bodyJoints";
import { withFingers, writeFingers } from "@shared/stage/fingers";
import type { BodyBinding } from "@shared/stage/skin/pose";

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

/** Joints in the T-pose as fractions of the stature, right side: `app/science/skeleton/model.py`. */
const MIDDLE: Readonly<Record<string, readonly number[]>> = {
  Hips: [0, 0.545, 0],
  Spine: [0, 0.585, 0],
  Chest: [0, 0.655, 0],
  UpperChest: [0, 0.725, 0],
  Neck: [0, 0.835, 0],
  Head: [0, 0.875, 0],
};
const RIGHT: Readonly<Record<string, readonly number[]>> = {
  Shoulder: [0.02, 0.81, 0],
  UpperArm: [0.129, 0.818, 0],
  LowerArm: [0.315, 0.818, 0],
  Hand: [0.461, 0.818, 0],
  UpperLeg: [0.05, 0.53, 0],
  LowerLeg: [0.05, 0.285, 0],
  Foot: [0.05, 0.039, 0],
  Toes: [0.05, 0.014, -0.072],
};

/** What is needed of a body to place its parts. */
export type Skeleton = Pick<BodyBinding, "stature_m" | "parts" | "parents" | "joints_m">;

/** The product's skeleton, 1 m tall: to be scaled to a stature. */
export const UNIT_SKELETON: Skeleton = {
  stature_m: 1,
  parts: JOINTS.joints,
  parents: JOINTS.parents,
  joints_m: NAMES.map((name) => {
    const [, side = "", part = name] = /^(Left|Right)(.+)$/.exec(name) ?? [];
    const [x = 0, y = 0, z = 0] = MIDDLE[part] ?? RIGHT[part] ?? [];
    return [side === "Left" ? -x : x, y, z];
  }),
};

/** The T-pose on the start square of somebody whose hips' joint is this high, metres. */
export function tPose(hipsHeightM: number): Float32Array {
  const pose = new Float32Array(POSE_VALUES);
  pose[1] = hipsHeightM;
  for (let joint = 0; joint < NAMES.length; joint++) pose[3 + 4 * joint] = 1;
  return pose;
}
