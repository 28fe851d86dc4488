/**
 * The plainest loop that simulates an avatar, to compare with: a ramp of targets, hips in straight
 * lines, steps. It has no touches, casts, soft contacts, gaps or failures, and its inverse
 * kinematics give the motors' angles directly.
 */
import type { MjData, MjModel } from "@mujoco/mujoco";
import type { Goals } from "@shared/avatar/goals";
import { InverseKinematics } from "@shared/avatar/ik";
import { type Mujoco, modelFrom } from "@shared/avatar/mujoco";

const MAX_SPEED_RAD_S = 40;

interface Hinge {
  readonly low: number;
  readonly high: number;
  readonly slot: number;
}

export class PlainLoop {
  ikMs = 0;
  remoteMs = 0;
  private readonly model: MjModel;
  private readonly data: MjData;
  private readonly ik: InverseKinematics;
  private readonly hinges: readonly Hinge[];
  private readonly command: Float64Array;
  private readonly from = [0, 0.95375, 0, 1, 0, 0, 0];
  private readonly stepS: number;
  private steps = 0;

  constructor(
    private readonly mujoco: Mujoco,
    mjcf: string,
  ) {
    this.model = modelFrom(mujoco, mjcf);
    this.data = new mujoco.MjData(this.model);
    this.ik = new InverseKinematics(mujoco, this.model);
    this.stepS = this.model.opt.timestep;
    const { mjOBJ_JOINT, mjOBJ_ACTUATOR } = mujoco.mjtObj;
    this.hinges = this.ik.axisNames.map((name) => {
      const joint = mujoco.mj_name2id(this.model, mjOBJ_JOINT.value, name);
      const motor = mujoco.mj_name2id(this.model, mjOBJ_ACTUATOR.value, name);
      return {
        low: this.model.jnt_range[2 * joint],
        high: this.model.jnt_range[2 * joint + 1],
        slot: motor < 0 ? -1 : this.model.actuator_ctrladr[motor],
      };
    });
    this.command = new Float64Array(this.hinges.length);
  }

  frame(timeS: number, goals: Goals): void {
    const begin = performance.now();
    const { hips, anglesRad } = this.ik.solve(goals);
    const solved = performance.now();
    this.stepTo(timeS, [...hips.positionM, ...hips.rotation], anglesRad);
    this.ikMs = solved - begin;
    this.remoteMs = performance.now() - solved;
  }

  dispose(): void {
    this.ik.delete();
    this.data.delete();
    this.model.delete();
  }

  private stepTo(timeS: number, hips: readonly number[], goal: Float64Array): void {
    const { mujoco, model, data, hinges, command, from } = this;
    const count = Math.round(timeS / this.stepS) - this.steps;
    if (count < 1) return;
    const durationS = count * this.stepS;
    const most = MAX_SPEED_RAD_S * durationS;
    const ctrl: Float64Array = data.ctrl;
    const pos: Float64Array = data.mocap_pos;
    const quat: Float64Array = data.mocap_quat;
    for (let step = 0; step < count; step++) {
      const share = (step + 0.5) / count;
      for (let i = 0; i < hinges.length; i++) {
        const { low, high, slot } = hinges[i] as Hinge;
        if (slot < 0) continue;
        let change = Math.min(Math.max(goal[i] as number, low), high) - (command[i] as number);
        if (change > most) change = most;
        else if (change < -most) change = -most;
        ctrl[slot] = (command[i] as number) + change * share;
        ctrl[slot + 1] = change / durationS;
        if (step === count - 1) command[i] = (command[i] as number) + change;
      }
      const way = (step + 1) / count;
      const at = (i: number) =>
        (from[i] as number) + way * ((hips[i] as number) - (from[i] as number));
      for (let i = 0; i < 3; i++) pos[i] = at(i);
      const q = [at(3), at(4), at(5), at(6)];
      const scale = 1 / Math.hypot(...q);
      for (let i = 0; i < 4; i++) quat[i] = (q[i] as number) * scale;
      mujoco.mj_step(model, data);
    }
    for (let i = 0; i < 7; i++) from[i] = hips[i] as number;
    this.steps += count;
    mujoco.mj_kinematics(model, data);
  }
}
