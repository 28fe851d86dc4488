/**
 * MuJoCo's own arrays of one model and its data, kept instead of asked for again and again: each
 * `data.x` makes a new view. When MuJoCo's memory grows, all views become empty at once and are
 * read again (`renewed`).
 */

import type { MjData, MjModel } from "@mujoco/mujoco";
import type { Mujoco } from "../mujoco";

export class Views {
  readonly timestepS: number;
  qpos!: Float64Array;
  qvel!: Float64Array;
  qaccWarmstart!: Float64Array;
  ctrl!: Float64Array;
  mocapPos!: Float64Array;
  mocapQuat!: Float64Array;
  xpos!: Float64Array;
  xquat!: Float64Array;
  xipos!: Float64Array;
  /** Where each joint's axis goes through, and its direction, in the world. */
  xanchor!: Float64Array;
  xaxis!: Float64Array;
  xfrcApplied!: Float64Array;
  actuatorForce!: Float64Array;
  geomXpos!: Float64Array;
  /** The memory in which MuJoCo keeps the contacts of the last step, from its first byte on. */
  arena!: Uint8Array;
  geomContype!: Int32Array;
  geomConaffinity!: Int32Array;
  geomPriority!: Int32Array;
  geomSolref!: Float64Array;
  geomSolimp!: Float64Array;
  geomRbound!: Float64Array;
  bodyContype!: Int32Array;
  bodyConaffinity!: Int32Array;
  bodyGravcomp!: Float64Array;
  jntRange!: Float64Array;
  actuatorDelay!: Float64Array;
  actuatorBiasprm!: Float64Array;
  actuatorForcerange!: Float64Array;
  gravity!: Float64Array;

  constructor(
    readonly mujoco: Mujoco,
    readonly model: MjModel,
    readonly data: MjData,
  ) {
    this.timestepS = model.opt.timestep;
    this.read();
  }

  /** Read the arrays again if MuJoCo's memory has grown since. */
  renewed(): this {
    if (this.qpos.length === 0) this.read();
    return this;
  }

  private read(): void {
    const { model, data } = this;
    this.qpos = data.qpos;
    this.qvel = data.qvel;
    this.qaccWarmstart = data.qacc_warmstart;
    this.ctrl = data.ctrl;
    this.mocapPos = data.mocap_pos;
    this.mocapQuat = data.mocap_quat;
    this.xpos = data.xpos;
    this.xquat = data.xquat;
    this.xipos = data.xipos;
    this.xanchor = data.xanchor;
    this.xaxis = data.xaxis;
    this.xfrcApplied = data.xfrc_applied;
    this.actuatorForce = data.actuator_force;
    this.geomXpos = data.geom_xpos;
    this.arena = data.arena;
    this.geomContype = model.geom_contype;
    this.geomConaffinity = model.geom_conaffinity;
    this.geomPriority = model.geom_priority;
    this.geomSolref = model.geom_solref;
    this.geomSolimp = model.geom_solimp;
    this.geomRbound = model.geom_rbound;
    this.bodyContype = model.body_contype;
    this.bodyConaffinity = model.body_conaffinity;
    this.bodyGravcomp = model.body_gravcomp;
    this.jntRange = model.jnt_range;
    this.actuatorDelay = model.actuator_delay;
    this.actuatorBiasprm = model.actuator_biasprm;
    this.actuatorForcerange = model.actuator_forcerange;
    this.gravity = model.opt.gravity;
  }
}
