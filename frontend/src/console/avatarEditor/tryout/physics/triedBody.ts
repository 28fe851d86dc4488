/**
 * One body that is tried: the simulation that the headset runs, driven by commands.
 *
 * The commanded pose is given to the same follower as a participant's, 100 times a second, so that
 * latency and targets in the room mean the same as in a session.
 */
import { AXES, JOINTS } from "@shared/avatar/anatomy.generated";
import type { Mujoco } from "@shared/avatar/mujoco";
import { Follower } from "@shared/avatar/physics/follower";
import { SimulationError } from "@shared/avatar/physics/modelTable";
import { type ConfigurationFile, limitsInForce, worldLimbs } from "@shared/avatar/physics/settings";
import { type Health, PhysicsAvatar } from "@shared/avatar/physics/simulation";
import { AXIS_COUNT, TargetAngles } from "@shared/avatar/physics/targetAngles";
import { type Capture, type Command, type Drive, frameAt, type Push, waveAt } from "./commands";
import { LooseBox } from "./looseBox";
import { TURN_VALUES, writeTurns } from "./turns";

/** Time between two commanded poses. */
export const TICK_S = 0.01;
const JOINT_VALUES = 4 * JOINTS.length;
/** The share of the torque limit from which a motor counts as saturated. */
const SATURATED = 0.999;

export interface BodyToTry {
  readonly mjcf: string;
  readonly configuration: ConfigurationFile;
}

/** How a whole body follows, at the last tick. */
export interface Following {
  /** Root mean square of the differences between target and angle, over all driven axes. */
  readonly rmsErrorRad: number;
  /** The axes whose motors are at their torque limit. */
  readonly saturated: readonly string[];
}

export class TriedBody {
  readonly avatar: PhysicsAvatar;
  /** Whether every number of the body was finite at the last tick. */
  isFinite = true;
  private readonly angles: TargetAngles;
  private readonly follower: Follower;
  private readonly box: LooseBox;
  private readonly standing: Float64Array;
  private readonly hips = new Float64Array(7);
  private readonly turns = new Float64Array(TURN_VALUES);
  private readonly fingers = this.turns.subarray(JOINT_VALUES);
  private readonly commandRad = new Float64Array(AXIS_COUNT);
  private readonly rowOfColumn = new Int32Array(AXIS_COUNT).fill(-1);
  private drive: Drive | null = null;
  private pose: Readonly<Record<string, number>> = {};
  private capture: Capture | null = null;
  private push: Push | null = null;
  private pushEndsS = Number.POSITIVE_INFINITY;
  private ticks = 0;
  /** The tick of the commands at which this body began; its own clock began with it. */
  private beganAt = 0;

  /** Throws SimulationError if the model is not an avatar with a box. */
  constructor(
    mujoco: Mujoco,
    { mjcf, configuration }: BodyToTry,
    /** The height of its hips when standing, as a share of a captured person's. */
    private readonly hipsScale = 1,
  ) {
    this.avatar = new PhysicsAvatar(mujoco, mjcf);
    this.box = new LooseBox(this.avatar.views, this.avatar.contacts);
    const { table, views } = this.avatar;
    this.angles = new TargetAngles(limitsInForce(configuration), new Set(table.bodies.keys()));
    this.follower = new Follower(
      this.avatar,
      this.angles,
      configuration.target_space,
      worldLimbs(configuration),
    );
    table.columns.forEach((column, row) => {
      this.rowOfColumn[column] = row;
    });
    this.standing = Float64Array.of(
      ...views.mocapPos.subarray(3 * table.mocap, 3 * table.mocap + 3),
      ...views.mocapQuat.subarray(4 * table.mocap, 4 * table.mocap + 4),
    );
    this.reset();
  }

  get timeS(): number {
    return this.ticks * TICK_S;
  }

  /** The tick of the commands: a body that joined another one later counts as that one does. */
  get commandTick(): number {
    return this.beganAt + this.ticks;
  }

  get health(): Health {
    return this.avatar.health;
  }

  get longestLatencyS(): number {
    return this.follower.longestDelayS;
  }

  /** Throws SimulationError for a part, axis or latency that the model does not have. */
  obey(command: Command): void {
    if (command.kind === "drive") {
      this.drive = command.drive;
      this.capture = null;
    } else if (command.kind === "pose") this.pose = command.anglesRad;
    else if (command.kind === "play") this.capture = command.capture;
    else if (command.kind === "push") this.setPush(command.push);
    else if (command.kind === "latency") this.follower.setDelay(command.latencyS);
    else if (command.kind === "gravity") this.avatar.switches.setGravity(command.isOn);
    else if (command.kind === "drop") this.box.drop(command.centerM);
    else this.reset(command.atTick);
  }

  /** Simulate 10 ms. */
  tick(): void {
    this.ticks += 1;
    const { timeS } = this;
    this.applyPush(timeS);
    this.writeCommand(this.commandTick * TICK_S);
    this.follower.frame(timeS, this.hips, this.turns, this.fingers);
    const { qpos } = this.avatar.views.renewed();
    let sum = 0;
    for (let i = 0; i < qpos.length; i++) sum += qpos[i] as number;
    this.isFinite = Number.isFinite(sum);
  }

  /** Target, angle and torque of an axis; NaN if the model has no hinge for it. */
  writeReading(column: number, into: Float64Array, at: number): void {
    const row = this.rowOfColumn[column] ?? -1;
    if (row < 0) {
      into.fill(Number.NaN, at, at + 3);
      return;
    }
    const { table, views } = this.avatar;
    into[at] = this.angles.anglesRad[column] as number;
    into[at + 1] = views.qpos[table.angles[row] as number] as number;
    into[at + 2] = views.actuatorForce[table.motors[row] as number] as number;
  }

  get following(): Following {
    const { table, views } = this.avatar;
    let squares = 0;
    const saturated: string[] = [];
    for (let row = 0; row < table.names.length; row++) {
      const target = this.angles.anglesRad[table.columns[row] as number] as number;
      squares += (target - (views.qpos[table.angles[row] as number] as number)) ** 2;
      const motor = table.motors[row] as number;
      const limit = views.actuatorForcerange[2 * motor + 1] as number;
      if (Math.abs(views.actuatorForce[motor] as number) >= SATURATED * limit) {
        saturated.push(table.names[row] as string);
      }
    }
    return { rmsErrorRad: Math.sqrt(squares / Math.max(table.names.length, 1)), saturated };
  }

  /** Write position and rotation (7 numbers) of every body of the model, the world's first. */
  writePlaces(into: Float32Array, at = 0): void {
    const { xpos, xquat } = this.avatar.views.renewed();
    for (let body = 0; 3 * body < xpos.length; body++) {
      for (let i = 0; i < 3; i++) into[at + 7 * body + i] = xpos[3 * body + i] as number;
      for (let i = 0; i < 4; i++) into[at + 7 * body + 3 + i] = xquat[4 * body + i] as number;
    }
  }

  /** Where a push acts now, in the world; null without one. */
  pushedAt(): Vector3 | null {
    const { push } = this;
    return push === null ? null : this.worldPoint(push);
  }

  dispose(): void {
    this.avatar.dispose();
  }

  /** Start again, at rest in the commanded pose, nobody pushing, the box out of sight. */
  private reset(atTick = 0): void {
    this.ticks = 0;
    this.beganAt = atTick;
    this.push = null;
    this.avatar.views.renewed().xfrcApplied.fill(0);
    this.box.park();
    this.avatar.rewind();
    this.writeCommand(atTick * TICK_S);
    this.follower.start(this.hips, this.turns, this.fingers);
  }

  private setPush(push: Push | null): void {
    if (push !== null && !this.avatar.table.bodies.has(push.part)) {
      throw new SimulationError(`This body has no ${push.part} that could be pushed.`);
    }
    this.avatar.views.renewed().xfrcApplied.fill(0);
    this.push = push;
    this.pushEndsS = this.timeS + (push?.forS ?? Number.POSITIVE_INFINITY);
  }

  /** MuJoCo takes the force at a body's centre of mass, and the torque that it has about it. */
  private applyPush(timeS: number): void {
    const { push } = this;
    if (push === null) return;
    const { table, views } = this.avatar;
    const { xfrcApplied, xipos } = views.renewed();
    const body = table.bodies.get(push.part) as number;
    if (timeS > this.pushEndsS + TICK_S / 2) {
      this.push = null;
      xfrcApplied.fill(0);
      return;
    }
    const [x, y, z] = this.worldPoint(push);
    const [fx, fy, fz] = push.forceN;
    const rx = x - (xipos[3 * body] as number);
    const ry = y - (xipos[3 * body + 1] as number);
    const rz = z - (xipos[3 * body + 2] as number);
    const at = 6 * body;
    xfrcApplied[at] = fx;
    xfrcApplied[at + 1] = fy;
    xfrcApplied[at + 2] = fz;
    xfrcApplied[at + 3] = ry * fz - rz * fy;
    xfrcApplied[at + 4] = rz * fx - rx * fz;
    xfrcApplied[at + 5] = rx * fy - ry * fx;
  }

  private worldPoint({ part, pointM }: Push): Vector3 {
    const { xpos, xquat, xipos } = this.avatar.views.renewed();
    const body = this.avatar.table.bodies.get(part) as number;
    if (pointM === null) {
      const [x, y, z] = xipos.subarray(3 * body, 3 * body + 3);
      return [x as number, y as number, z as number];
    }
    const w = xquat[4 * body] as number;
    const x = xquat[4 * body + 1] as number;
    const y = xquat[4 * body + 2] as number;
    const z = xquat[4 * body + 3] as number;
    const [px, py, pz] = pointM;
    // p + 2 w (u x p) + 2 u x (u x p), of the vector part u.
    const cx = y * pz - z * py;
    const cy = z * px - x * pz;
    const cz = x * py - y * px;
    return [
      (xpos[3 * body] as number) + px + 2 * (w * cx + y * cz - z * cy),
      (xpos[3 * body + 1] as number) + py + 2 * (w * cy + z * cx - x * cz),
      (xpos[3 * body + 2] as number) + pz + 2 * (w * cz + x * cy - y * cx),
    ];
  }

  private writeCommand(timeS: number): void {
    const { capture, drive, hips } = this;
    if (capture !== null) {
      this.writeCaptured(capture, frameAt(capture, timeS));
      return;
    }
    hips.set(this.standing);
    this.commandRad.fill(0);
    for (const axis in this.pose) this.commandRad[columnOf(axis)] = this.pose[axis] as number;
    if (drive !== null) this.commandRad[columnOf(drive.axis)] = waveAt(drive.wave, timeS);
    writeTurns(this.commandRad, this.turns);
    // The hips are not driven: where they stand they look ahead.
    this.turns.set(this.standing.subarray(3), 0);
  }

  private writeCaptured(capture: Capture, frame: number): void {
    const { hips, turns } = this;
    turns.fill(0);
    for (let at = 0; at < TURN_VALUES; at += 4) turns[at] = 1;
    turns.set(capture.rotations.subarray(JOINT_VALUES * frame, JOINT_VALUES * (frame + 1)));
    hips.set(capture.hipsM.subarray(3 * frame, 3 * frame + 3));
    hips[1] = this.hipsScale * (hips[1] as number);
    hips.set(turns.subarray(0, 4), 3);
  }
}

function columnOf(axis: string): number {
  const column = COLUMNS.get(axis);
  if (column === undefined) throw new SimulationError(`There is no axis ${axis}.`);
  return column;
}

type Vector3 = readonly [x: number, y: number, z: number];
export const COLUMNS = new Map<string, number>(AXES.map(({ name }, column) => [name, column]));
