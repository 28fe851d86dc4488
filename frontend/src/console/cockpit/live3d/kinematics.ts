/**
 * Forward kinematics: positions from local rotations, as in `app/science/skeleton/kinematics.py`.
 */
import type { PoseSetup } from "@shared/api/poses";
import { multiply, type Quaternion, rotate, type Vector } from "@shared/rotations";

/** A body's joints, their parents (-1: the world), and where each is in its parent's frame. */
type Joints = Pick<PoseSetup, "joints" | "parents" | "offsets_m">;

export interface Placed {
  /** x, y, z of every joint, metres in the world. Overwritten by `place`. */
  readonly positions: Float32Array;
  /** w, x, y, z of every joint: the rotation world from joint. */
  readonly rotations: Float32Array;
}

export const makePlaced = (joints: number): Placed => ({
  positions: new Float32Array(3 * joints),
  rotations: new Float32Array(4 * joints),
});

/** Place the joints; `values` are root position and rotations wxyz. NaN stays NaN. */
export function place(setup: Joints, values: Float32Array, into: Placed): void {
  const { positions, rotations } = into;
  setup.parents.forEach((parent, joint) => {
    const [w = 1, x = 0, y = 0, z = 0] = values.subarray(3 + 4 * joint, 7 + 4 * joint);
    if (parent < 0) {
      positions.set(values.subarray(0, 3), 3 * joint);
      rotations.set([w, x, y, z], 4 * joint);
      return;
    }
    rotations.set(multiply(rotationOf(rotations, parent), [w, x, y, z]), 4 * joint);
    const offset = rotateToWorld(rotations, parent, setup.offsets_m[joint] ?? [0, 0, 0]);
    for (let axis = 0; axis < 3; axis++) {
      positions[3 * joint + axis] = (positions[3 * parent + axis] ?? 0) + (offset[axis] ?? 0);
    }
  });
}

/** Rotate a vector from a joint's own frame into the world. */
const rotateToWorld = (rotations: Float32Array, joint: number, vector: Vector): Vector =>
  rotate(rotationOf(rotations, joint), vector);

export function rotationOf(rotations: Float32Array, joint: number): Quaternion {
  const [w = 1, x = 0, y = 0, z = 0] = rotations.subarray(4 * joint, 4 * joint + 4);
  return [w, x, y, z];
}

/** The rest pose, standing on the floor: a body's proportions before it moves. */
export function restValues(setup: Joints): Float32Array {
  const values = new Float32Array(3 + 4 * setup.joints.length);
  values.set(setup.offsets_m[0] ?? [0, 0, 0]);
  for (let joint = 0; joint < setup.joints.length; joint++) values[3 + 4 * joint] = 1;
  return values;
}
