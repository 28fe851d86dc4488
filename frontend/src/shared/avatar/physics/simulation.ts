/**
 * Simulate a physics avatar: one body in one scene, stepped on the frames' clock.
 *
 * The server's `app/science/avatar/simulation/simulation.py` explains the method and what is done
 * about irregular input; the same model and inputs give the same trajectory (vectors in
 * `tests/vectors/avatar`). Nothing is allocated in a frame.
 */
import type { MjData, MjModel } from "@mujoco/mujoco";
import { FINGER_PARTS, JOINTS } from "../anatomy.generated";
import { type Mujoco, modelFrom } from "../mujoco";
import { Contacts } from "./contacts";
import { HipsPath } from "./hipsPath";
import { type ModelTable, SimulationError, tableOf } from "./modelTable";
import { clamp, inverseMultiplyRows, roundHalfEven } from "./numbers";
import { SoftContacts } from "./softContacts";
import { Boxes, Switches } from "./switches";
import { AXIS_COUNT } from "./targetAngles";
import { Views } from "./views";

const MAX_SPEED_RAD_S = 40;
const FAILURE_RAD_S = 1000;
const FAILURE_ANGLES = 1e5;

/** Counts of irregular inputs and failures since the simulation started. */
export interface Health {
  /** Frames after which the simulation had failed and was restored. */
  readonly restored: number;
  /** Times at which MuJoCo had started anew by itself; its clock was at zero. */
  readonly resets: number;
  readonly ignoredInputs: number;
  readonly limitedTargets: number;
  readonly teleports: number;
}

export class PhysicsAvatar {
  readonly model: MjModel;
  readonly data: MjData;
  readonly views: Views;
  readonly table: ModelTable;
  readonly contacts: Contacts;
  readonly hips: HipsPath;
  readonly switches: Switches;
  readonly boxes: Boxes;
  /** The angles of the axes in the order of `AXES`; NaN where the model has no hinge. */
  readonly anglesRad = new Float64Array(AXIS_COUNT).fill(Number.NaN);
  private readonly softContacts: SoftContacts;
  private readonly goal: Float64Array;
  private readonly command: Float64Array;
  private readonly changes: Float64Array;
  private readonly previousQpos: Float64Array;
  private steps = 0;
  private restored = 0;
  private resets = 0;
  private ignoredInputs = 0;
  private limitedTargets = 0;
  /** Greatest speed of targets; lower while the body catches up after a gap. */
  private fastestRadS = MAX_SPEED_RAD_S;

  constructor(
    private readonly mujoco: Mujoco,
    mjcf: string,
  ) {
    try {
      this.model = modelFrom(mujoco, mjcf);
    } catch (error) {
      throw new SimulationError(`MuJoCo cannot load the model: ${String(error)}`);
    }
    // Failures are handled here, not by MuJoCo's reset to time zero.
    this.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET.value;
    this.data = new mujoco.MjData(this.model);
    this.table = tableOf(mujoco, this.model);
    this.views = new Views(mujoco, this.model, this.data);
    mujoco.mj_kinematics(this.model, this.data);
    this.contacts = new Contacts(this.views);
    this.hips = new HipsPath(this.views, this.table);
    this.switches = new Switches(this.views, this.table);
    this.softContacts = new SoftContacts(this.views, this.table, this.contacts);
    this.boxes = new Boxes(this.views, this.table, () => this.softContacts.softenAll());
    const count = this.table.names.length;
    this.goal = new Float64Array(count);
    this.command = new Float64Array(count);
    this.changes = new Float64Array(count);
    this.previousQpos = new Float64Array(this.views.qpos.length);
    this.resetTo(new Float64Array(AXIS_COUNT));
  }

  get timeS(): number {
    return this.steps * this.views.timestepS;
  }

  get health(): Health {
    const { restored, resets, ignoredInputs, limitedTargets } = this;
    return { restored, resets, ignoredInputs, limitedTargets, teleports: this.hips.teleports };
  }

  /**
   * Put the avatar into a pose immediately and at rest, and fill the latency buffer with it.
   *
   * `hips`: position and world_from_hips (7); `anglesRad`: in the order of `AXES`, clamped here.
   */
  startAt(hips: Float64Array, anglesRad: Float64Array): void {
    this.views.renewed();
    for (const column of this.table.columns) {
      if (!Number.isFinite(anglesRad[column])) {
        throw new SimulationError("Every angle of a starting pose must be finite.");
      }
    }
    if (!this.hips.teleport(hips)) {
      throw new SimulationError(`The hips cannot be at ${hips.join(", ")}.`);
    }
    this.softContacts.softenAll();
    this.resetTo(anglesRad);
  }

  /** Set the clock to zero and forget the latency buffer; call `startAt` next. */
  rewind(): void {
    this.mujoco.mj_resetData(this.model, this.data);
    this.steps = 0;
    this.fastestRadS = MAX_SPEED_RAD_S;
  }

  /** Set the pose of the hips at the time of the next `stepTo`: position and rotation (7). */
  setHips(pose: Float64Array): void {
    this.views.renewed();
    const { teleports } = this.hips;
    if (!this.hips.goTo(pose)) this.ignoredInputs += 1;
    if (this.hips.teleports > teleports) this.softContacts.softenAll();
  }

  /** Set the target angles at the time of the next `stepTo`, in the order of `AXES`. */
  setTargets(anglesRad: Float64Array): void {
    const { columns } = this.table;
    let isWhole = true;
    for (let row = 0; row < columns.length; row++) {
      const angle = anglesRad[columns[row] as number] as number;
      if (Number.isFinite(angle)) this.goal[row] = angle;
      else isWhole = false;
    }
    if (!isWhole) this.ignoredInputs += 1;
  }

  /** Go on at this moment after a gap: hips and limbs move to the next pose gently. */
  catchUp(hips: Float64Array, fastestRadS: number): void {
    this.views.renewed();
    if (this.hips.teleport(hips)) this.softContacts.softenAll();
    this.fastestRadS = fastestRadS;
  }

  /** Simulate up to the step nearest to this time. */
  stepTo(timeS: number): void {
    const views = this.views.renewed();
    const stepS = views.timestepS;
    if (!(timeS >= this.timeS - stepS)) {
      throw new SimulationError(`Time ${timeS} s lies before the avatar's, ${this.timeS} s.`);
    }
    const count = roundHalfEven(timeS / stepS) - this.steps;
    if (count < 1) return;
    this.previousQpos.set(views.qpos);
    this.simulate(count);
    this.steps += count;
    this.hips.go(1);
    const hasReset = this.data.time < this.timeS - stepS;
    if (hasReset) this.resets += 1;
    this.contacts.read();
    if (hasReset || this.hasFailed()) this.restore();
    else this.softContacts.watch();
    this.mujoco.mj_kinematics(this.model, this.data);
  }

  /** Write the pose: the hips' position, then 22 local rotations, from `at` on (91 values). */
  writePose(into: Float64Array, at = 0): void {
    const { xpos, xquat } = this.views.renewed();
    const { jointBodies, parentBodies } = this.table;
    const hips = 3 * (jointBodies[0] as number);
    for (let i = 0; i < 3; i++) into[at + i] = xpos[hips + i] as number;
    for (let joint = 0; joint < JOINTS.length; joint++) {
      const above = 4 * (parentBodies[joint] as number);
      const own = 4 * (jointBodies[joint] as number);
      inverseMultiplyRows(xquat, above, xquat, own, into, at + 3 + 4 * joint);
    }
  }

  /** Write the local rotations of the 30 finger parts, from `at` on (120 values). */
  writeFingers(into: Float64Array, at = 0): void {
    const { xquat } = this.views.renewed();
    const { fingerBodies, aboveFingers } = this.table;
    for (let part = 0; part < FINGER_PARTS.length; part++) {
      const above = 4 * (aboveFingers[part] as number);
      inverseMultiplyRows(
        xquat,
        above,
        xquat,
        4 * (fingerBodies[part] as number),
        into,
        at + 4 * part,
      );
    }
  }

  /** Read the current angles into `anglesRad`. */
  readAngles(): Float64Array {
    const { qpos } = this.views.renewed();
    const { columns, angles } = this.table;
    for (let row = 0; row < columns.length; row++) {
      this.anglesRad[columns[row] as number] = qpos[angles[row] as number] as number;
    }
    return this.anglesRad;
  }

  /** Free MuJoCo's memory. */
  dispose(): void {
    this.data.delete();
    this.model.delete();
  }

  /** Simulate the steps of one frame while targets and hips move to their new values. */
  private simulate(count: number): void {
    const { mujoco, model, data, views, changes, command } = this;
    const durationS = count * views.timestepS;
    this.switches.moveCasts(durationS);
    this.limitChanges(durationS);
    const { slots } = this.table;
    for (let step = 0; step < count; step++) {
      const { ctrl } = views.renewed();
      // The motors act from the beginning of a step to its end: targets are those at its middle.
      const share = (step + 0.5) / count;
      for (let row = 0; row < slots.length; row++) {
        const slot = slots[row] as number;
        const change = changes[row] as number;
        ctrl[slot] = (command[row] as number) + change * share;
        ctrl[slot + 1] = change / durationS;
      }
      this.hips.go((step + 1) / count);
      mujoco.mj_step(model, data);
    }
    views.renewed();
    for (let row = 0; row < slots.length; row++) {
      command[row] = (command[row] as number) + (changes[row] as number);
    }
  }

  /** Compute how far each command moves in this frame. */
  private limitChanges(durationS: number): void {
    const { goal, command, changes } = this;
    const { rangesRad } = this.switches;
    const farthest = this.fastestRadS * durationS;
    let isLimited = false;
    for (let row = 0; row < goal.length; row++) {
      const low = rangesRad[2 * row] as number;
      const high = rangesRad[2 * row + 1] as number;
      let change = clamp(goal[row] as number, low, high) - (command[row] as number);
      if (Math.abs(change) > farthest) {
        isLimited = true;
        change = change > 0 ? farthest : -farthest;
      }
      changes[row] = change;
    }
    if (!isLimited) this.fastestRadS = MAX_SPEED_RAD_S;
    else if (this.fastestRadS === MAX_SPEED_RAD_S) this.limitedTargets += 1;
  }

  private hasFailed(): boolean {
    const { qpos, qvel } = this.views;
    let speeds = 0;
    let angles = 0;
    for (let i = 0; i < qvel.length; i++) speeds += (qvel[i] as number) ** 2;
    for (let i = 0; i < qpos.length; i++) angles += (qpos[i] as number) ** 2;
    // Comparisons with NaN are false.
    return !(speeds < FAILURE_RAD_S ** 2 && angles < FAILURE_ANGLES ** 2);
  }

  private restore(): void {
    this.restored += 1;
    const { views, table } = this;
    const { rangesRad } = this.switches;
    views.qpos.set(this.previousQpos);
    for (let row = 0; row < table.angles.length; row++) {
      const at = table.angles[row] as number;
      views.qpos[at] = clamp(
        this.previousQpos[at] as number,
        rangesRad[2 * row] as number,
        rangesRad[2 * row + 1] as number,
      );
    }
    views.qvel.fill(0);
    views.qaccWarmstart.fill(0);
    this.data.time = this.timeS;
    this.hips.putRoot();
    this.softContacts.softenAll();
  }

  private resetTo(anglesRad: Float64Array): void {
    const { views, table, goal, command } = this;
    const { rangesRad } = this.switches;
    for (let row = 0; row < table.names.length; row++) {
      const angle = clamp(
        anglesRad[table.columns[row] as number] as number,
        rangesRad[2 * row] as number,
        rangesRad[2 * row + 1] as number,
      );
      goal[row] = angle;
      command[row] = angle;
      views.qpos[table.angles[row] as number] = angle;
      views.ctrl[table.slots[row] as number] = angle;
      views.ctrl[(table.slots[row] as number) + 1] = 0;
    }
    views.qvel.fill(0);
    views.qaccWarmstart.fill(0);
    this.fillHistory();
    this.contacts.read();
    this.mujoco.mj_kinematics(this.model, this.data);
  }

  /** Fill the buffer of every motor's latency with its current targets. */
  private fillHistory(): void {
    const { model, data, mujoco, views } = this;
    const history: Int32Array = model.actuator_history;
    const ctrlAt: Int32Array = model.actuator_ctrladr;
    for (let motor = 0; motor < ctrlAt.length; motor++) {
      const samples = history[2 * motor] ?? 0;
      if (samples === 0) continue;
      const at = ctrlAt[motor] as number;
      const pair = [views.ctrl[at] as number, views.ctrl[at + 1] as number];
      const values = Array.from({ length: 2 * samples }, (_, index) => pair[index % 2] as number);
      mujoco.mj_initCtrlHistory(model, data, motor, [], values);
    }
  }
}
