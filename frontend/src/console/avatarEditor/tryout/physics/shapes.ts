/** The shapes of a model as it is simulated, for drawing: each is fixed to one of its bodies. */
import type { MjModel } from "@mujoco/mujoco";
import type { Mujoco } from "@shared/avatar/mujoco";
import type { ModelTable } from "@shared/avatar/physics/modelTable";
import { BOX } from "./looseBox";

/** Metres; `sizeM` as in MuJoCo: radius and half length of a capsule, half sizes of a box. */
export interface Shape {
  readonly body: number;
  /** The part that it belongs to; `box` for the box that can be dropped. */
  readonly part: string;
  readonly kind: "sphere" | "capsule" | "box" | "mesh";
  readonly sizeM: readonly [number, number, number];
  /** In the body's frame; rotation w, x, y, z. */
  readonly positionM: readonly [number, number, number];
  readonly rotation: readonly [number, number, number, number];
  /** The corners of a convex piece, x, y, z after one another; empty for the others. */
  readonly cornersM: Float32Array;
  /** Whether it collides; a part without colliders is drawn too, but see-through. */
  readonly collides: boolean;
}

/** List the shapes that a body is drawn with: of each part those that collide, or else the simple ones. */
export function shapesOf(mujoco: Mujoco, model: MjModel, table: ModelTable): readonly Shape[] {
  const { mjOBJ_GEOM } = mujoco.mjtObj;
  const kinds = kindsOf(mujoco);
  const all = table.partOfGeom.flatMap((owner, geom): Shape[] => {
    const isBox = mujoco.mj_id2name(model, mjOBJ_GEOM.value, geom) === BOX;
    const part = isBox ? BOX : owner;
    const kind = kinds.get((model.geom_type as Int32Array)[geom] as number);
    if (part === null || kind === undefined) return [];
    return [
      {
        body: table.geomBodies[geom] as number,
        part,
        kind,
        sizeM: three(model.geom_size, 3 * geom),
        positionM: three(model.geom_pos, 3 * geom),
        rotation: four(model.geom_quat, 4 * geom),
        cornersM: kind === "mesh" ? cornersOf(model, geom) : new Float32Array(0),
        collides: isBox || ((model.geom_contype as Int32Array)[geom] as number) !== 0,
      },
    ];
  });
  const solid = new Set(all.filter(({ collides }) => collides).map(({ part }) => part));
  return all.filter(({ part, collides, kind }) => (solid.has(part) ? collides : kind !== "mesh"));
}

const kindsOf = (mujoco: Mujoco): ReadonlyMap<number, Shape["kind"]> => {
  const { mjGEOM_SPHERE, mjGEOM_CAPSULE, mjGEOM_BOX, mjGEOM_MESH } = mujoco.mjtGeom;
  return new Map([
    [mjGEOM_SPHERE.value, "sphere"],
    [mjGEOM_CAPSULE.value, "capsule"],
    [mjGEOM_BOX.value, "box"],
    [mjGEOM_MESH.value, "mesh"],
  ]);
};

function cornersOf(model: MjModel, geom: number): Float32Array {
  const mesh = (model.geom_dataid as Int32Array)[geom] as number;
  const from = 3 * ((model.mesh_vertadr as Int32Array)[mesh] as number);
  const count = 3 * ((model.mesh_vertnum as Int32Array)[mesh] as number);
  return Float32Array.from((model.mesh_vert as Float32Array).subarray(from, from + count));
}

const three = (from: Float64Array, at: number): [number, number, number] => [
  from[at] as number,
  from[at + 1] as number,
  from[at + 2] as number,
];

const four = (from: Float64Array, at: number): [number, number, number, number] => [
  ...three(from, at),
  from[at + 3] as number,
];
