/**
 * Generated poses to look at a body in: the T-pose, standing, and walking on the spot. They are
 * curves drawn by hand, not anybody's movement.
 */

import { BODY } from "@shared/bodyJoints";
import { multiply, type Quaternion } from "@shared/rotations";
import type { PointMotion } from "@shared/stage/motion";
import { type BodyBinding, numbersOf, Parts, type PoseSource } from "@shared/stage/skin/pose";
import { AVATAR_MAP } from "../captures/bodyJoints";

export type ExamplePose = "rest" | "stand" | "walk";
export const EXAMPLE_POSES: readonly ExamplePose[] = ["rest", "stand", "walk"];

const RATE_HZ = 30;
/** Frames after which a pose repeats. */
const FRAMES: Readonly<Record<ExamplePose, number>> = { rest: 1, stand: 120, walk: 34 };
const JOINTS = Object.keys(AVATAR_MAP);
const PARENTS = JOINTS.map((joint) => JOINTS.indexOf(BODY[joint] ?? ""));
const FEET = ["LeftFoot", "RightFoot", "LeftToes", "RightToes"];

export interface Example {
  readonly motion: PointMotion;
  readonly pose: PoseSource;
}

/** A pose of a body of this stature, with its lowest foot on the floor. */
export function example(binding: BodyBinding, statureM: number, kind: ExamplePose): Example {
  const scale = statureM / binding.stature_m;
  const pose = { joints: JOINTS, parents: PARENTS };
  const parts = new Parts(binding, scale, pose);
  const frames = FRAMES[kind];
  const numbers = numbersOf(JOINTS);
  const all = new Float32Array(frames * numbers);
  const positions = new Float32Array(frames * binding.parts.length * 3);
  const feet = binding.parts.flatMap((part, index) => (FEET.includes(part) ? [index] : []));
  for (let frame = 0; frame < frames; frame++) {
    const values = all.subarray(frame * numbers, (frame + 1) * numbers);
    const angles = anglesAt(kind, frame / frames);
    JOINTS.forEach((joint, index) => {
      values.set(angles[joint] ?? NOT_TURNED, 3 + 4 * index);
    });
    const [x = 0, y = 0, z = 0] = binding.joints_m[0] ?? [];
    values.set([scale * x, scale * y, scale * z]);
    parts.place(values);
    const above = feet.map(
      (foot) => (parts.places[3 * foot + 1] ?? 0) - scale * (binding.joints_m[foot]?.[1] ?? 0),
    );
    values[1] = (values[1] ?? 0) - Math.min(...above);
    parts.place(values);
    positions.set(parts.places, frame * parts.places.length);
  }
  return {
    motion: {
      kind: "skeleton",
      names: binding.parts,
      parents: binding.parents,
      frames,
      rateHz: RATE_HZ,
      recordedRateHz: RATE_HZ,
      positions,
    },
    pose: {
      ...pose,
      read: (frame, values) => values.set(all.subarray(frame * numbers, (frame + 1) * numbers)),
    },
  };
}

type Angles = Readonly<Record<string, Quaternion>>;

const NOT_TURNED: Quaternion = [1, 0, 0, 0];

const about = (axis: 1 | 2 | 3, degrees: number): Quaternion => {
  const half = (degrees * Math.PI) / 360;
  const turned: [number, number, number, number] = [Math.cos(half), 0, 0, 0];
  turned[axis] = Math.sin(half);
  return turned;
};

const [X, Y, Z] = [1, 2, 3] as const;

/** The rotations of a pose; `phase` runs from 0 to 1. */
function anglesAt(kind: ExamplePose, phase: number): Angles {
  if (kind === "rest") return {};
  const turn = 2 * Math.PI * phase;
  if (kind === "stand") {
    const breath = Math.sin(turn);
    return {
      ...arm("Left", 2 + 1.5 * breath, 12),
      ...arm("Right", 2 + 1.5 * breath, 12),
      Chest: about(X, 0.8 * breath),
      Neck: about(Y, 4 * Math.sin(turn)),
    };
  }
  return {
    ...leg("Left", turn),
    ...leg("Right", turn + Math.PI),
    ...arm("Left", -20 * Math.cos(turn), 22),
    ...arm("Right", 20 * Math.cos(turn), 22),
    Hips: about(Y, -4 * Math.cos(turn)),
    Chest: about(Y, 7 * Math.cos(turn)),
  };
}

/** A hanging arm, swung forward and bent at the elbow by these angles in degrees. */
function arm(side: "Left" | "Right", swing: number, bend: number): Angles {
  const down = side === "Left" ? 1 : -1;
  return {
    [`${side}Shoulder`]: about(Z, 7 * down),
    [`${side}UpperArm`]: multiply(about(X, swing), about(Z, 66 * down)),
    [`${side}LowerArm`]: about(Y, -bend * down),
  };
}

/** A leg in a step: the thigh swings, the knee bends while it comes forward. */
function leg(side: "Left" | "Right", turn: number): Angles {
  const forward = Math.max(0, Math.cos(turn - 1.45 * Math.PI));
  return {
    [`${side}UpperLeg`]: about(X, 5 + 23 * Math.cos(turn)),
    [`${side}LowerLeg`]: about(X, -(8 + 48 * forward * forward)),
    [`${side}Foot`]: about(X, 6 * Math.cos(turn + 0.6)),
  };
}
