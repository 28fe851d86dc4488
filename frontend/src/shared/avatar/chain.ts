/**
 * The avatar's model as inverse kinematics uses it: hips that can be placed, hinges, tracked parts.
 *
 * Every access to one of MuJoCo's arrays makes a new view, so the views are kept. When its memory
 * grows, all of them become empty at once and are read again.
 */
import type { MjData, MjModel } from "@mujoco/mujoco";
import { length, minus, type Quaternion, type Vector, writeRotationBetween } from "../rotations";
import { GOAL_PARTS, IkError } from "./goals";
import type { Place, Trunk } from "./hips";
import type { Mujoco } from "./mujoco";

export interface Hinge {
  readonly name: string;
  readonly qposAt: number;
  readonly joint: number;
  readonly bodyId: number;
  readonly lowRad: number;
  readonly highRad: number;
}

export class Chain {
  /** Every hinge, in the order of the model. */
  readonly hinges: readonly Hinge[];
  /** The limits of every hinge. */
  readonly lowsRad: Float64Array;
  readonly highsRad: Float64Array;
  /** Indices of the hinges that move a tracked part. */
  readonly moving: readonly number[];
  /** For each of these hinges, whether it moves each goal. */
  readonly moves: readonly (readonly boolean[])[];
  readonly trunk: Trunk;
  private readonly data: MjData;
  private readonly bodies: readonly number[];
  private readonly mocap: number;
  private readonly freeAt: number | null;
  private qpos!: Float64Array;
  private xpos!: Float64Array;
  private xquat!: Float64Array;
  private mocapPos!: Float64Array;
  private mocapQuat!: Float64Array;
  private xaxis!: Float64Array;
  private xanchor!: Float64Array;

  constructor(
    private readonly mujoco: Mujoco,
    private readonly model: MjModel,
  ) {
    this.bodies = GOAL_PARTS.map((part) => this.body(part));
    this.hinges = readHinges(mujoco, model);
    this.lowsRad = Float64Array.from(this.hinges, ({ lowRad }) => lowRad);
    this.highsRad = Float64Array.from(this.hinges, ({ highRad }) => highRad);
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
    this.readViews();
    this.trunk = this.measured();
  }

  /** Set the pose: the hips in the world and the angle of every hinge. */
  place(hipsM: Vector, hips: Quaternion, anglesRad: Float64Array): void {
    if (this.qpos.length === 0) this.readViews();
    const { qpos, hinges, freeAt } = this;
    for (let index = 0; index < hinges.length; index++) {
      qpos[(hinges[index] as Hinge).qposAt] = anglesRad[index] as number;
    }
    const position = freeAt === null ? this.mocapPos : qpos;
    const rotation = freeAt === null ? this.mocapQuat : qpos;
    const at = freeAt ?? 3 * this.mocap;
    const from = freeAt === null ? 4 * this.mocap : freeAt + 3;
    for (let i = 0; i < 3; i++) position[at + i] = hipsM[i] as number;
    for (let i = 0; i < 4; i++) rotation[from + i] = hips[i] as number;
    this.mujoco.mj_kinematics(this.model, this.data);
    if (this.qpos.length === 0) this.readViews();
  }

  positionM(goal: number): Vector {
    return vectorAt(this.xpos, 3 * (this.bodies[goal] as number));
  }

  /** Write how far a part is from its goal: the way (m), then the rotation vector (rad). */
  writeError(goal: number, { positionM, rotation }: Place, into: Float64Array, at: number): void {
    const body = this.bodies[goal] as number;
    for (let i = 0; i < 3; i++) {
      into[at + i] = (positionM[i] as number) - (this.xpos[3 * body + i] as number);
    }
    writeRotationBetween(this.xquat, 4 * body, rotation, into, at + 3);
  }

  /** Write six rows that say how a part moves with the hips, into a matrix of this width. */
  writeRigid(goal: number, hipsM: Vector, into: Float64Array, start: number, width: number): void {
    const at = 3 * (this.bodies[goal] as number);
    const x = (this.xpos[at] as number) - hipsM[0];
    const y = (this.xpos[at + 1] as number) - hipsM[1];
    const z = (this.xpos[at + 2] as number) - hipsM[2];
    for (let row = 0; row < 3; row++) {
      into[start + row * width + row] = 1;
      into[start + (row + 3) * width + row + 3] = 1;
    }
    const turn = start + 3;
    into[turn + 1] = z;
    into[turn + 2] = -y;
    into[turn + width] = -z;
    into[turn + width + 2] = x;
    into[turn + 2 * width] = y;
    into[turn + 2 * width + 1] = -x;
  }

  /**
   * Write six rows (velocity, angular velocity) per moving hinge into a matrix of this width, which
   * holds zeros where a hinge does not move the part.
   *
   * A hinge turns the part about its axis a through its anchor c: the part at p moves by a x (p - c).
   * MuJoCo's own function does the same, and makes strings for its arguments in every call.
   */
  writeJacobian(goal: number, into: Float64Array, start: number, width: number): void {
    const { moving, hinges, xpos, xaxis, xanchor } = this;
    const moved = this.moves[goal] as readonly boolean[];
    const body = 3 * (this.bodies[goal] as number);
    for (let column = 0; column < moving.length; column++) {
      if (!moved[column]) continue;
      const joint = 3 * (hinges[moving[column] as number] as Hinge).joint;
      const ax = xaxis[joint] as number;
      const ay = xaxis[joint + 1] as number;
      const az = xaxis[joint + 2] as number;
      const px = (xpos[body] as number) - (xanchor[joint] as number);
      const py = (xpos[body + 1] as number) - (xanchor[joint + 1] as number);
      const pz = (xpos[body + 2] as number) - (xanchor[joint + 2] as number);
      const at = start + column;
      into[at] = ay * pz - az * py;
      into[at + width] = az * px - ax * pz;
      into[at + 2 * width] = ax * py - ay * px;
      into[at + 3 * width] = ax;
      into[at + 4 * width] = ay;
      into[at + 5 * width] = az;
    }
  }

  /** Free MuJoCo's memory, except for the model, which belongs to the caller. */
  delete(): void {
    this.data.delete();
  }

  private readViews(): void {
    const { data } = this;
    this.qpos = data.qpos;
    this.xpos = data.xpos;
    this.xquat = data.xquat;
    this.mocapPos = data.mocap_pos;
    this.mocapQuat = data.mocap_quat;
    this.xaxis = data.xaxis;
    this.xanchor = data.xanchor;
  }

  private measured(): Trunk {
    this.place([0, 0, 0], [1, 0, 0, 0], new Float64Array(this.hinges.length));
    const [left, right] = ["LeftUpperLeg", "RightUpperLeg"].map((part) =>
      vectorAt(this.xpos, 3 * this.body(part)),
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

function vectorAt(values: Float64Array, at: number): Vector {
  return [values[at] as number, values[at + 1] as number, values[at + 2] as number];
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
        joint,
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
