/**
 * The avatar's model as inverse kinematics uses it: hips that can be placed, hinges, tracked parts.
 *
 * Views of MuJoCo's arrays become invalid when its memory grows, so each is fetched again where it
 * is used.
 */
import type { DoubleBuffer, MjData, MjModel } from "@mujoco/mujoco";
import { length, minus, type Quaternion, type Vector } from "../rotations";
import { GOAL_PARTS, IkError } from "./goals";
import type { Trunk } from "./hips";
import type { Mujoco } from "./mujoco";

interface Hinge {
  readonly name: string;
  readonly qposAt: number;
  readonly dofAt: number;
  readonly bodyId: number;
  readonly lowRad: number;
  readonly highRad: number;
}

export class Chain {
  /** Every hinge, in the order of the model. */
  readonly hinges: readonly Hinge[];
  /** Indices of the hinges that move a tracked part. */
  readonly moving: readonly number[];
  /** For each of these hinges, whether it moves each goal. */
  readonly moves: readonly (readonly boolean[])[];
  readonly trunk: Trunk;
  private readonly data: MjData;
  private readonly bodies: readonly number[];
  private readonly mocap: number;
  private readonly freeAt: number | null;
  private readonly linear: DoubleBuffer;
  private readonly angular: DoubleBuffer;

  constructor(
    private readonly mujoco: Mujoco,
    private readonly model: MjModel,
  ) {
    this.bodies = GOAL_PARTS.map((part) => this.body(part));
    this.hinges = readHinges(mujoco, model);
    const moves = this.bodies.map((body) => {
      const ancestors = above(model, body);
      return this.hinges.map((hinge) => ancestors.has(hinge.bodyId));
    });
    this.moving = [...this.hinges.keys()].filter((index) => moves.some((row) => row[index]));
    this.moves = moves.map((row) => this.moving.map((index) => row[index] === true));
    const hips = this.bodies[0] as number;
    this.mocap = model.body_mocapid[hips];
    this.freeAt = freeAddress(mujoco, model, hips);
    if (this.freeAt === null && this.mocap < 0) {
      throw new IkError(
        "The model's Hips are fixed: they must be a mocap body or hang on a free joint.",
      );
    }
    this.data = new mujoco.MjData(model);
    this.linear = new mujoco.DoubleBuffer(3 * model.nv);
    this.angular = new mujoco.DoubleBuffer(3 * model.nv);
    this.trunk = this.measured();
  }

  /** Set the pose: the hips in the world and the angle of every hinge. */
  place(hipsM: Vector, hips: Quaternion, anglesRad: Float64Array): void {
    const qpos: Float64Array = this.data.qpos;
    this.hinges.forEach((hinge, index) => {
      qpos[hinge.qposAt] = anglesRad[index] as number;
    });
    if (this.freeAt === null) {
      (this.data.mocap_pos as Float64Array).set(hipsM, 3 * this.mocap);
      (this.data.mocap_quat as Float64Array).set(hips, 4 * this.mocap);
    } else {
      qpos.set(hipsM, this.freeAt);
      qpos.set(hips, this.freeAt + 3);
    }
    this.mujoco.mj_kinematics(this.model, this.data);
  }

  /** Call after `place` and before `writeJacobian`. */
  prepareJacobians(): void {
    this.mujoco.mj_comPos(this.model, this.data);
  }

  positionM(goal: number): Vector {
    return vectorAt(this.data.xpos, 3 * (this.bodies[goal] as number));
  }

  rotation(goal: number): Quaternion {
    return quaternionAt(this.data.xquat, 4 * (this.bodies[goal] as number));
  }

  /** Write six rows (velocity, angular velocity) per moving hinge into a matrix of this width. */
  writeJacobian(goal: number, into: Float64Array, start: number, width: number): void {
    this.mujoco.mj_jacBody(
      this.model,
      this.data,
      this.linear,
      this.angular,
      this.bodies[goal] as number,
    );
    const nv: number = this.model.nv;
    const halves: readonly Float64Array[] = [this.linear.GetView(), this.angular.GetView()];
    this.moving.forEach((hinge, column) => {
      const dof = (this.hinges[hinge] as Hinge).dofAt;
      for (let row = 0; row < 6; row++) {
        const half = halves[row < 3 ? 0 : 1] as Float64Array;
        into[start + row * width + column] = half[(row % 3) * nv + dof] as number;
      }
    });
  }

  /** Free MuJoCo's memory, except for the model, which belongs to the caller. */
  delete(): void {
    for (const owned of [this.data, this.linear, this.angular]) owned.delete();
  }

  private measured(): Trunk {
    this.place([0, 0, 0], [1, 0, 0, 0], new Float64Array(this.hinges.length));
    const [left, right] = ["LeftUpperLeg", "RightUpperLeg"].map((part) =>
      vectorAt(this.data.xpos, 3 * this.body(part)),
    ) as [Vector, Vector];
    const thighs = [
      length(minus(this.positionM(4), left)),
      length(minus(this.positionM(5), right)),
    ];
    return {
      hipsToHeadM: length(this.positionM(1)),
      hipsToSocketsM: -0.5 * (left[1] + right[1]),
      halfBreadthM: 0.5 * (right[0] - left[0]),
      thighM: 0.5 * ((thighs[0] as number) + (thighs[1] as number)),
    };
  }

  private body(part: string): number {
    const found = this.mujoco.mj_name2id(this.model, this.mujoco.mjtObj.mjOBJ_BODY.value, part);
    if (found < 0) {
      throw new IkError(
        `The model has no ${part}: inverse kinematics needs ${GOAL_PARTS.join(", ")} and the` +
          " parts between them.",
      );
    }
    return found;
  }
}

export function vectorAt(values: Float64Array, at: number): Vector {
  return [values[at] as number, values[at + 1] as number, values[at + 2] as number];
}

export function quaternionAt(values: Float64Array, at: number): Quaternion {
  return [...vectorAt(values, at), values[at + 3] as number];
}

function readHinges(mujoco: Mujoco, model: MjModel): readonly Hinge[] {
  const joints = [...Array(model.njnt).keys()];
  const hinge = mujoco.mjtJoint.mjJNT_HINGE.value;
  return joints
    .filter((joint) => model.jnt_type[joint] === hinge)
    .map((joint) => {
      const limited = model.jnt_range[2 * joint] < model.jnt_range[2 * joint + 1];
      return {
        name: mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT.value, joint),
        qposAt: model.jnt_qposadr[joint],
        dofAt: model.jnt_dofadr[joint],
        bodyId: model.jnt_bodyid[joint],
        lowRad: limited ? model.jnt_range[2 * joint] : -Infinity,
        highRad: limited ? model.jnt_range[2 * joint + 1] : Infinity,
      };
    });
}

function above(model: MjModel, body: number): ReadonlySet<number> {
  const ancestors = new Set<number>();
  for (let at = body; at > 0; at = model.body_parentid[at]) ancestors.add(at);
  return ancestors;
}

function freeAddress(mujoco: Mujoco, model: MjModel, hips: number): number | null {
  const free = mujoco.mjtJoint.mjJNT_FREE.value;
  for (let joint = 0; joint < model.njnt; joint++) {
    if (model.jnt_bodyid[joint] === hips && model.jnt_type[joint] === free) {
      return model.jnt_qposadr[joint];
    }
  }
  return null;
}
