/**
 * Forward kinematics: positions from local rotations, as in `app/science/skeleton/kinematics.py`.
 */
import type { PoseSetup } from "@shared/api/poses";

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
export function place(setup: PoseSetup, values: Float32Array, into: Placed): void {
  const { positions, rotations } = into;
  setup.parents.forEach((parent, joint) => {
    const [w = 1, x = 0, y = 0, z = 0] = values.subarray(3 + 4 * joint, 7 + 4 * joint);
    if (parent < 0) {
      positions.set(values.subarray(0, 3), 3 * joint);
      rotations.set([w, x, y, z], 4 * joint);
      return;
    }
    const [pw = 1, px = 0, py = 0, pz = 0] = rotations.subarray(4 * parent, 4 * parent + 4);
    rotations[4 * joint] = pw * w - px * x - py * y - pz * z;
    rotations[4 * joint + 1] = pw * x + px * w + py * z - pz * y;
    rotations[4 * joint + 2] = pw * y - px * z + py * w + pz * x;
    rotations[4 * joint + 3] = pw * z + px * y - py * x + pz * w;
    const offset = rotateToWorld(rotations, parent, setup.offsets_m[joint] ?? [0, 0, 0]);
    for (let axis = 0; axis < 3; axis++) {
      positions[3 * joint + axis] = (positions[3 * parent + axis] ?? 0) + (offset[axis] ?? 0);
    }
  });
}

type Vector = readonly [x: number, y: number, z: number];

/** Rotate a vector from a joint's own frame into the world. */
export function rotateToWorld(turns: Float32Array, joint: number, [x, y, z]: Vector): Vector {
  const [w = 1, a = 0, b = 0, c = 0] = turns.subarray(4 * joint, 4 * joint + 4);
  // v + 2 u x (u x v + w v)
  const tx = 2 * (b * z - c * y);
  const ty = 2 * (c * x - a * z);
  const tz = 2 * (a * y - b * x);
  return [x + w * tx + b * tz - c * ty, y + w * ty + c * tx - a * tz, z + w * tz + a * ty - b * tx];
}

/** The rest pose, standing on the floor: a body's proportions before it moves. */
export function restValues(setup: PoseSetup): Float32Array {
  const values = new Float32Array(3 + 4 * setup.joints.length);
  values.set(setup.offsets_m[0] ?? [0, 0, 0]);
  for (let joint = 0; joint < setup.joints.length; joint++) values[3 + 4 * joint] = 1;
  return values;
}
