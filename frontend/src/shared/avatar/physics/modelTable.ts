/** Where an avatar's hinges, motors, parts and shapes are in the arrays of its MuJoCo model. */
import type { MjModel } from "@mujoco/mujoco";
import { AXES, FINGER_PARTS, JOINT_PARENTS, JOINTS, PARTS } from "../anatomy.generated";
import type { Mujoco } from "../mujoco";

/** A model is not an avatar, or lacks something named, or a value is not valid. */
export class SimulationError extends Error {
  override name = "SimulationError";
}

const HIPS_TARGET = "HipsTarget";
const WORLD = 0;
const PARENT = new Map<string, string | null>(PARTS.map(({ name, parent }) => [name, parent]));

export const parentOf = (part: string): string | null => PARENT.get(part) ?? null;

/** The server's `HingeTable`; the n hinges are in the model's order. */
export interface ModelTable {
  readonly names: readonly string[];
  /** Columns of these axes in `AXES`. */
  readonly columns: Int32Array;
  readonly joints: Int32Array;
  /** Indices into `qpos` and `qvel`. */
  readonly angles: Int32Array;
  /** Rows of their motors. */
  readonly motors: Int32Array;
  /** Indices into `ctrl`; each is followed by the speed's target. */
  readonly slots: Int32Array;
  /** Part -> body. */
  readonly bodies: ReadonlyMap<string, number>;
  /** Body that carries each joint of the skeleton, and that of its parent; the world's is 0. */
  readonly jointBodies: Int32Array;
  readonly parentBodies: Int32Array;
  readonly fingerBodies: Int32Array;
  readonly aboveFingers: Int32Array;
  readonly mocap: number;
  /** First indices of welded hips in `qpos` and `qvel`; null where the hips are carried. */
  readonly rootAngles: number | null;
  readonly rootSpeeds: number | null;
  /** The part of each geom's body; null in the scene. */
  readonly partOfGeom: readonly (string | null)[];
  readonly geomBodies: Int32Array;
  /** Whether each geom is a convex piece of skin. */
  readonly isPiece: readonly boolean[];
  /** Name -> geom of the scene. */
  readonly sceneGeoms: ReadonlyMap<string, number>;
}

export function tableOf(mujoco: Mujoco, model: MjModel): ModelTable {
  const { mjOBJ_BODY, mjOBJ_JOINT, mjOBJ_GEOM, mjOBJ_ACTUATOR } = mujoco.mjtObj;
  const nameOf = (kind: { value: number }, row: number): string =>
    mujoco.mj_id2name(model, kind.value, row) ?? "";
  const rows = (count: number) => [...Array(count).keys()];
  const bodyRows = new Map(rows(model.nbody).map((row) => [nameOf(mjOBJ_BODY, row), row]));
  const bodies = new Map(
    PARTS.flatMap(({ name }) => {
      const row = bodyRows.get(name);
      return row === undefined ? [] : [[name as string, row] as const];
    }),
  );
  const hips = bodies.get("Hips");
  if (hips === undefined || model.nmocap !== 1) {
    throw new SimulationError("The model has no hips that can be placed: it is not an avatar.");
  }
  const joints = new Map(rows(model.njnt).map((row) => [nameOf(mjOBJ_JOINT, row), row]));
  const columnOf = new Map<string, number>(AXES.map(({ name }, column) => [name, column]));
  const names = [...joints.keys()].filter((name) => columnOf.has(name));
  const jointRows = Int32Array.from(names, (name) => joints.get(name) as number);
  const motors = Int32Array.from(names, (name) =>
    mujoco.mj_name2id(model, mjOBJ_ACTUATOR.value, name),
  );
  const qposAt: Int32Array = model.jnt_qposadr;
  const dofAt: Int32Array = model.jnt_dofadr;
  const ctrlAt: Int32Array = model.actuator_ctrladr;
  const root = joints.get("Hips");
  const jointBodies = jointCarriers(bodies);
  const geomBodies = Int32Array.from(model.geom_bodyid as Int32Array);
  const partOfBody = new Map([...bodies].map(([part, body]) => [body, part]));
  const geoms = rows(model.ngeom);
  const mesh = mujoco.mjtGeom.mjGEOM_MESH.value;
  return {
    names,
    columns: Int32Array.from(names, (name) => columnOf.get(name) as number),
    joints: jointRows,
    angles: Int32Array.from(jointRows, (row) => qposAt[row] as number),
    motors,
    slots: Int32Array.from(motors, (row) => ctrlAt[row] as number),
    bodies,
    jointBodies,
    parentBodies: Int32Array.from(JOINT_PARENTS, (above) =>
      above < 0 ? WORLD : (jointBodies[above] as number),
    ),
    fingerBodies: Int32Array.from(FINGER_PARTS, (part) => carrierOf(part, bodies)),
    aboveFingers: Int32Array.from(FINGER_PARTS, (part) => carrierOf(parentOf(part), bodies)),
    mocap: (model.body_mocapid as Int32Array)[bodyRows.get(HIPS_TARGET) ?? hips] as number,
    rootAngles: root === undefined ? null : (qposAt[root] as number),
    rootSpeeds: root === undefined ? null : (dofAt[root] as number),
    partOfGeom: geoms.map((geom) => partOfBody.get(geomBodies[geom] as number) ?? null),
    geomBodies,
    isPiece: geoms.map((geom) => (model.geom_type as Int32Array)[geom] === mesh),
    sceneGeoms: new Map(
      geoms
        .filter((geom) => geomBodies[geom] === WORLD)
        .map((geom) => [nameOf(mjOBJ_GEOM, geom), geom]),
    ),
  };
}

/** The body of a part or, if the model lacks it, of the nearest part above it. */
function carrierOf(part: string | null, bodies: ReadonlyMap<string, number>): number {
  for (let at = part; at !== null; at = parentOf(at)) {
    const found = bodies.get(at);
    if (found !== undefined) return found;
  }
  return WORLD;
}

function jointCarriers(bodies: ReadonlyMap<string, number>): Int32Array {
  const carriers = new Int32Array(JOINTS.length);
  JOINTS.forEach((joint, row) => {
    carriers[row] = bodies.get(joint) ?? (carriers[JOINT_PARENTS[row] as number] as number);
  });
  return carriers;
}
