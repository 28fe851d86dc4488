/**
 * The bones of one body that is worn: placed in the world by a pose, for all meshes that draw it.
 * This module imports three.js.
 */
import {
  Bone,
  type BufferGeometry,
  DetachedBindMode,
  type Material,
  Matrix4,
  Skeleton,
  SkinnedMesh,
  type Sphere,
} from "three";
import { type ArmsM, withArms } from "./arms";
import type { BodyModel } from "./bodyModel";
import { Parts, type PoseSource } from "./pose";

const IDENTITY = new Matrix4();

export class BodyBones {
  readonly parts: Parts;
  /** By skin of the model. */
  readonly skeletons: readonly Skeleton[];
  readonly #bones: readonly Bone[];
  /** By part: the node's place in its part, in the wearer's size. */
  readonly #partFromNode: readonly Matrix4[];

  constructor(
    readonly model: BodyModel,
    statureM: number,
    pose: Pick<PoseSource, "joints" | "parents">,
    /** Arms other than the model's own. */
    armsM: ArmsM = {},
  ) {
    const binding = withArms(model.binding, statureM, armsM);
    const scale = statureM / binding.stature_m;
    this.parts = new Parts(binding, scale, pose);
    this.#bones = model.nodes.map(() => new Bone());
    this.#partFromNode = binding.part_from_node.map((rows) => scaled(rows, scale));
    this.skeletons = model.skins.map(({ joints, inverses }) => {
      const bones = joints.map((joint) => this.#bones[joint] as Bone);
      return new Skeleton(bones, inverses);
    });
  }

  /** Place the bones; leave them where they are and return false if the pose is not fully known. */
  place(values: ArrayLike<number>): boolean {
    if (!this.parts.place(values)) return false;
    const { nodes } = this.model;
    const { places, rotations } = this.parts;
    for (let index = 0; index < nodes.length; index++) {
      const node = nodes[index];
      const world = this.#bones[index]?.matrixWorld;
      if (node === undefined || world === undefined) continue;
      const { part, parent } = node;
      if (part < 0) {
        world.multiplyMatrices(this.nodeWorld(parent), node.local);
        continue;
      }
      setPose(world, places, 3 * part, rotations, 4 * part);
      world.multiply(this.#partFromNode[part] ?? IDENTITY);
    }
    return true;
  }

  /** The world from one of the model's nodes, as it was placed last. */
  nodeWorld(node: number): Matrix4 {
    return this.#bones[node]?.matrixWorld ?? IDENTITY;
  }

  dispose(): void {
    for (const skeleton of this.skeletons) skeleton.dispose();
  }
}

/** A mesh moved by bones that are placed in the world, wherever the mesh itself is. */
export function skinned(
  geometry: BufferGeometry,
  material: Material | Material[],
  skeleton: Skeleton,
  middle: Sphere,
): SkinnedMesh {
  const mesh = new SkinnedMesh(geometry, material);
  mesh.bind(skeleton, IDENTITY);
  mesh.bindMode = DetachedBindMode;
  // The figure moves all the time, and drawing what is out of view is cheap.
  mesh.frustumCulled = false;
  mesh.boundingSphere = middle;
  return mesh;
}

/** A matrix from 16 numbers row by row, for a body of another size. */
function scaled(rows: readonly number[], by: number): Matrix4 {
  const matrix = new Matrix4().fromArray([...rows]).transpose();
  const { elements } = matrix;
  for (let column = 0; column < 4; column++) {
    for (let row = 0; row < 3; row++)
      elements[4 * column + row] = (elements[4 * column + row] ?? 0) * by;
  }
  return matrix;
}

/** Set a matrix to a place and a rotation, which are at these indices. */
function setPose(
  matrix: Matrix4,
  places: Float64Array,
  place: number,
  rotations: Float64Array,
  rotation: number,
): void {
  const w = rotations[rotation] ?? 1;
  const x = rotations[rotation + 1] ?? 0;
  const y = rotations[rotation + 2] ?? 0;
  const z = rotations[rotation + 3] ?? 0;
  // biome-ignore format: as a matrix is written
  matrix.set(
    1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), places[place] ?? 0,
    2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), places[place + 1] ?? 0,
    2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), places[place + 2] ?? 0,
    0, 0, 0, 1,
  );
}
