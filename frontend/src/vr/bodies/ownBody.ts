/**
 * The local body: the participant's own, posed by inverse kinematics from what is tracked.
 *
 * In a session with a physics avatar it has the joints of the session's model, which has the
 * participant's stature; otherwise those of the skeleton of that stature.
 */
import type { MjModel } from "@mujoco/mujoco";
import { AXES, JOINT_PARENTS, JOINTS } from "@shared/avatar/anatomy.generated";
import type { Goals } from "@shared/avatar/goals";
import { InverseKinematics, type Solution } from "@shared/avatar/ik";
import { type Mujoco, modelFrom } from "@shared/avatar/mujoco";
import { multiplyRows } from "@shared/avatar/physics/numbers";
import { type SegmentsM, unitSkeleton } from "./armLengths";

const JOINT_ROW = new Map<string, number>(JOINTS.map((name, row) => [name, row]));

export class OwnBody {
  /** Root position and 22 local rotations (91). */
  readonly pose = new Float64Array(3 + 4 * JOINTS.length);
  readonly goalErrorsM: Float64Array;
  private readonly solver: InverseKinematics;
  private readonly turn = new Float64Array(4);
  /** For every hinge of a joint: its row of the pose and its axis; null for other hinges. */
  private readonly hinges: readonly ({
    readonly at: number;
    readonly direction: readonly number[];
  } | null)[];

  constructor(mujoco: Mujoco, model: MjModel) {
    this.solver = new InverseKinematics(mujoco, model);
    const axes = new Map<string, (typeof AXES)[number]>(AXES.map((axis) => [axis.name, axis]));
    this.hinges = this.solver.axisNames.map((name) => {
      const axis = axes.get(name);
      const row = axis && JOINT_ROW.get(axis.part);
      return axis && row !== undefined
        ? { at: 3 + 4 * row, direction: axis.direction as readonly number[] }
        : null;
    });
    this.goalErrorsM = new Float64Array(6);
  }

  /** Pose the body so that its tracked parts are where their goals are. */
  follow(goals: Goals): void {
    const solution: Solution = this.solver.solve(goals);
    this.goalErrorsM.set(solution.positionErrorsM);
    const { pose, turn } = this;
    pose.set(solution.hips.positionM);
    pose.set(solution.hips.rotation, 3);
    for (let row = 1; row < JOINTS.length; row++) {
      pose[3 + 4 * row] = 1;
      pose.fill(0, 4 + 4 * row, 7 + 4 * row);
    }
    for (let index = 0; index < this.hinges.length; index++) {
      const hinge = this.hinges[index];
      if (hinge === null || hinge === undefined) continue;
      const half = (solution.anglesRad[index] as number) / 2;
      const s = Math.sin(half);
      turn[0] = Math.cos(half);
      for (let i = 0; i < 3; i++) turn[i + 1] = s * (hinge.direction[i] as number);
      multiplyRows(pose, hinge.at, turn, 0, pose, hinge.at);
    }
  }

  /** Forget the previous frame, as after a gap in the tracking. */
  forget(): void {
    this.solver.reset();
  }

  dispose(): void {
    this.solver.delete();
  }
}

/** The model of a person's skeleton for inverse kinematics; the caller must `delete()` it. */
export function skeletonModel(mujoco: Mujoco, statureM: number, segmentsM?: SegmentsM): MjModel {
  return modelFrom(mujoco, skeletonMjcf(statureM, segmentsM));
}

function skeletonMjcf(statureM: number, segmentsM?: SegmentsM): string {
  const { offsets } = unitSkeleton(statureM, segmentsM);
  const body = (row: number): string => {
    const name = JOINTS[row] as string;
    const place = [0, 1, 2].map((i) => statureM * (offsets[3 * row + i] as number)).join(" ");
    const hinges = AXES.filter((axis) => axis.part === name).map(
      ({ name: axis, direction, lowRad, highRad }) =>
        (lowRad as number) === highRad
          ? ""
          : `<joint name="${axis}" axis="${direction.join(" ")}" range="${lowRad} ${highRad}"/>`,
    );
    const children = JOINTS.map((_, child) => child)
      .filter((child) => JOINT_PARENTS[child] === row)
      .map(body);
    const mocap = row === 0 ? ' mocap="true"' : "";
    return (
      `<body name="${name}" pos="${place}"${mocap}>` +
      `<geom size="0.01" mass="1"/>${hinges.join("")}${children.join("")}</body>`
    );
  };
  return (
    '<mujoco><compiler angle="radian"/><option timestep="0.002"/>' +
    '<default><joint type="hinge" limited="true"/><geom type="sphere" contype="0" conaffinity="0"/>' +
    `</default><worldbody>${body(0)}</worldbody></mujoco>`
  );
}
