/**
 * The pose of a body over time, and the places of its parts in a pose: forward kinematics over the
 * body's own joints (`app/science/avatar/body/binding.py` describes the model).
 */

import { FINGER_PARTS, withFingers, writeFingers } from "../fingers";
import type { PointMotion } from "../motion";

/**
 * Which nodes of a model's file move with which parts of a body, in the T-pose facing -z, y up, on
 * the floor, in the model's own size.
 *
 * The world from a node is the world from its part times `part_from_node`, 16 numbers row by row.
 */
export interface BodyBinding {
  readonly stature_m: number;
  /** Names of HumanBodyBones, parents first, the hips at the beginning. */
  readonly parts: readonly string[];
  readonly parents: readonly number[];
  /** The place of each part's joint above the floor, metres. */
  readonly joints_m: readonly (readonly number[])[];
  /** The index of the node in the model's file that moves with the part. */
  readonly nodes: readonly number[];
  readonly part_from_node: readonly (readonly number[])[];
}

/** Rotations of joints over time, with the place of the first one, the hips. */
export interface PoseSource {
  /** Names of HumanBodyBones, parents first. */
  readonly joints: readonly string[];
  readonly parents: readonly number[];
  /**
   * Write a frame: the place of the hips in metres, then the rotation wxyz of each joint in its
   * parent's frame. Unknown numbers are NaN.
   */
  readonly read: (frame: number, values: Float32Array) => void;
}

/** A pose that is written in place, as it arrives. */
export interface LivePose extends PoseSource {
  readonly values: Float32Array;
}

export const numbersOf = (joints: readonly string[]): number => 3 + 4 * joints.length;

export function livePose(joints: readonly string[], parents: readonly number[]): LivePose {
  const values = new Float32Array(numbersOf(joints)).fill(Number.NaN);
  return { joints, parents, values, read: (_, into) => into.set(values) };
}

/** A pose in which nothing is rotated: the T-pose, with the hips at a place. */
export function restPose(
  joints: readonly string[],
  hipsM: readonly [x: number, y: number, z: number],
): Float32Array {
  const values = new Float32Array(numbersOf(joints));
  values.set(hipsM);
  for (let joint = 0; joint < joints.length; joint++) values[3 + 4 * joint] = 1;
  return values;
}

/** The pose in a movement with rotations; null if only positions are known. */
export function poseOf(motion: PointMotion): PoseSource | null {
  const { names: joints, parents, positions, rotations, fingers } = motion;
  if (rotations === undefined) return null;
  const read = (frame: number, values: Float32Array): void => {
    const place = 3 * frame * joints.length;
    for (let axis = 0; axis < 3; axis++) values[axis] = positions[place + axis] ?? Number.NaN;
    const from = 4 * frame * joints.length;
    for (let at = 0; at < 4 * joints.length; at++) {
      values[3 + at] = rotations[from + at] ?? Number.NaN;
    }
    if (fingers === undefined) return;
    writeFingers(fingers, 4 * frame * FINGER_PARTS.length, values, numbersOf(joints));
  };
  return fingers === undefined
    ? { joints, parents, read }
    : { ...withFingers(joints, parents), read };
}

/**
 * The parts of one body, placed in the world without allocating anything.
 *
 * A part that is a joint of the pose has that joint's rotation in the world; any other part moves
 * with its parent. So a body without a chest still bends where its participant does.
 */
export class Parts {
  /** x, y, z of each part's joint, metres in the world. Overwritten by `place`. */
  readonly places: Float64Array;
  /** w, x, y, z of each part: the rotation world from part. Overwritten by `place`. */
  readonly rotations: Float64Array;
  readonly #parents: readonly number[];
  readonly #offsets: Float64Array;
  readonly #jointOf: readonly number[];
  readonly #jointParents: readonly number[];
  readonly #jointRotations: Float64Array;

  constructor(
    binding: BodyBinding,
    /** Factor from the model's own size to the wearer's. */
    readonly scale: number,
    pose: Pick<PoseSource, "joints" | "parents">,
  ) {
    const count = binding.parts.length;
    this.places = new Float64Array(3 * count);
    this.rotations = new Float64Array(4 * count);
    this.#parents = binding.parents;
    this.#jointOf = binding.parts.map((part) => pose.joints.indexOf(part));
    this.#jointParents = pose.parents;
    this.#jointRotations = new Float64Array(4 * pose.joints.length);
    this.#offsets = new Float64Array(3 * count);
    binding.parents.forEach((parent, part) => {
      for (let axis = 0; axis < 3 && parent >= 0; axis++) {
        const [own = 0, above = 0] = [part, parent].map((one) => binding.joints_m[one]?.[axis]);
        this.#offsets[3 * part + axis] = scale * (own - above);
      }
    });
  }

  /** Place the parts; leave them where they are and return false if the pose is not fully known. */
  place(values: ArrayLike<number>): boolean {
    const joints = this.#jointRotations.length / 4;
    if (!isKnown(values, joints)) return false;
    for (let joint = 0; joint < joints; joint++) {
      const parent = this.#jointParents[joint] ?? -1;
      turn(this.#jointRotations, parent, values, 3 + 4 * joint, this.#jointRotations, joint);
    }
    for (let part = 0; part < this.#parents.length; part++) this.#placePart(part, values);
    return true;
  }

  #placePart(part: number, values: ArrayLike<number>): void {
    const { places, rotations } = this;
    const parent = this.#parents[part] ?? -1;
    const joint = this.#jointOf[part] ?? -1;
    const source = joint >= 0 ? this.#jointRotations : rotations;
    const from = joint >= 0 ? joint : parent;
    for (let at = 0; at < 4; at++) {
      rotations[4 * part + at] = from < 0 ? Number(at === 0) : (source[4 * from + at] ?? 0);
    }
    if (parent < 0) {
      for (let axis = 0; axis < 3; axis++) places[3 * part + axis] = values[axis] ?? 0;
      return;
    }
    const w = rotations[4 * parent] ?? 1;
    const x = rotations[4 * parent + 1] ?? 0;
    const y = rotations[4 * parent + 2] ?? 0;
    const z = rotations[4 * parent + 3] ?? 0;
    const vx = this.#offsets[3 * part] ?? 0;
    const vy = this.#offsets[3 * part + 1] ?? 0;
    const vz = this.#offsets[3 * part + 2] ?? 0;
    const cx = 2 * (y * vz - z * vy);
    const cy = 2 * (z * vx - x * vz);
    const cz = 2 * (x * vy - y * vx);
    places[3 * part] = (places[3 * parent] ?? 0) + vx + w * cx + y * cz - z * cy;
    places[3 * part + 1] = (places[3 * parent + 1] ?? 0) + vy + w * cy + z * cx - x * cz;
    places[3 * part + 2] = (places[3 * parent + 2] ?? 0) + vz + w * cz + x * cy - y * cx;
  }
}

/** Whether every number is known and no rotation is missing. */
function isKnown(values: ArrayLike<number>, joints: number): boolean {
  for (let axis = 0; axis < 3; axis++) if (!Number.isFinite(values[axis])) return false;
  for (let at = 3; at < 3 + 4 * joints; at += 4) {
    const w = values[at] ?? 0;
    const x = values[at + 1] ?? 0;
    const y = values[at + 2] ?? 0;
    const z = values[at + 3] ?? 0;
    // Neither NaN nor a rotation of zeros passes.
    if (!(w * w + x * x + y * y + z * z > 0)) return false;
  }
  return true;
}

/** Write the product of a parent's rotation (none: the world's) and a normalised local one. */
function turn(
  above: Float64Array,
  parent: number,
  local: ArrayLike<number>,
  at: number,
  into: Float64Array,
  index: number,
): void {
  let w = local[at] ?? 1;
  let x = local[at + 1] ?? 0;
  let y = local[at + 2] ?? 0;
  let z = local[at + 3] ?? 0;
  const scale = 1 / Math.sqrt(w * w + x * x + y * y + z * z);
  w *= scale;
  x *= scale;
  y *= scale;
  z *= scale;
  const aw = parent < 0 ? 1 : (above[4 * parent] ?? 1);
  const ax = parent < 0 ? 0 : (above[4 * parent + 1] ?? 0);
  const ay = parent < 0 ? 0 : (above[4 * parent + 2] ?? 0);
  const az = parent < 0 ? 0 : (above[4 * parent + 3] ?? 0);
  into[4 * index] = aw * w - ax * x - ay * y - az * z;
  into[4 * index + 1] = aw * x + ax * w + ay * z - az * y;
  into[4 * index + 2] = aw * y - ax * z + ay * w + az * x;
  into[4 * index + 3] = aw * z + ax * y - ay * x + az * w;
}
