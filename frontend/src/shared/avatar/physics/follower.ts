/**
 * Make an avatar follow one participant: each frame's pose becomes the motors' targets.
 *
 * The server's `app/science/avatar/simulation/following.py` explains the two target spaces. `local`:
 * joints follow the participant's joint angles, and added latency is that of the motors' buffer.
 * `world`: arms and head keep their orientation in the room while something pushes the trunk, and
 * added latency is applied to the poses, as it is with limbs that have world targets (`limbYield`).
 * The hips are never delayed.
 */
import { AXES, FINGER_PARTS, JOINTS } from "../anatomy.generated";
import { DelayBuffer } from "./delayBuffer";
import { LimbYield } from "./limbYield";
import { inverseMultiplyRows, multiplyRows, slerpRows } from "./numbers";
import type { TargetSpace } from "./settings";
import type { PhysicsAvatar } from "./simulation";
import type { TargetAngles } from "./targetAngles";

const YIELD_S = 0.1;
const JOINT_VALUES = 4 * JOINTS.length;
const FINGER_VALUES = 4 * FINGER_PARTS.length;
const LIMBS = ["Neck", "LeftShoulder", "RightShoulder"].map(
  (name) => 4 * (JOINTS as readonly string[]).indexOf(name),
);
const TRUNK = AXES.flatMap(({ part, direction }, column) =>
  part === "Spine" || part === "Chest" || part === "UpperChest" ? [{ column, direction }] : [],
);

export class Follower {
  private readonly poses: DelayBuffer | null;
  private readonly limbs: LimbYield | null;
  private readonly given = new Float64Array(JOINT_VALUES + FINGER_VALUES);
  private readonly pose = new Float64Array(JOINT_VALUES + FINGER_VALUES);
  private readonly deviation = Float64Array.of(1, 0, 0, 0);
  private readonly inverse = new Float64Array(4);
  private readonly targetChest = new Float64Array(4);
  private readonly actualChest = new Float64Array(4);
  private readonly now = new Float64Array(4);
  private readonly turn = new Float64Array(4);

  constructor(
    private readonly avatar: PhysicsAvatar,
    private readonly angles: TargetAngles,
    private readonly targetSpace: TargetSpace,
    worldLimbs: readonly string[] = [],
  ) {
    this.limbs = worldLimbs.length > 0 ? new LimbYield(worldLimbs) : null;
    const givesWay = targetSpace === "world" || this.limbs !== null;
    this.poses = givesWay ? new DelayBuffer(JOINT_VALUES + FINGER_VALUES) : null;
  }

  /** Change the added latency from the next frame on. */
  setDelay(delayS: number): void {
    if (this.poses === null) this.avatar.switches.setDelay(delayS);
    else this.poses.setDelay(delayS);
  }

  /** The longest latency that can be added. */
  get longestDelayS(): number {
    return this.poses === null ? this.avatar.switches.longestDelayS : 2;
  }

  /**
   * Put the avatar into a pose immediately and at rest.
   *
   * `hips`: position and world_from_hips (7); `rotations`: 22 local rotations; `fingers`: 30.
   */
  start(hips: Float64Array, rotations: Float64Array, fingers: Float64Array | null): void {
    this.angles.forget();
    this.avatar.startAt(hips, this.angles.follow(rotations, 0, fingers));
    this.deviation.set([1, 0, 0, 0]);
    this.limbs?.forget();
    this.poses?.clear();
  }

  /** Simulate the avatar up to the time of a frame, on the avatar's clock. */
  frame(
    timeS: number,
    hips: Float64Array,
    rotations: Float64Array,
    fingers: Float64Array | null,
  ): void {
    const { avatar, angles, poses } = this;
    const elapsedS = Math.max(timeS - avatar.timeS, 0);
    let targets: Float64Array;
    if (poses === null) targets = angles.follow(rotations, 0, fingers);
    else {
      this.given.set(rotations);
      if (fingers !== null) this.given.set(fingers, JOINT_VALUES);
      this.pose.set(poses.push(timeS, this.given));
      if (this.targetSpace === "world") this.giveWay();
      const late = fingers === null ? null : this.pose;
      targets = angles.follow(this.pose, 0, late, JOINT_VALUES);
    }
    avatar.setHips(hips);
    avatar.setTargets(this.limbs?.commands(targets) ?? targets);
    avatar.stepTo(timeS);
    this.limbs?.note(targets, avatar.readAngles(), elapsedS);
    if (this.targetSpace === "world") this.noteDeviation(targets, elapsedS);
  }

  /** Turn neck and shoulders against the deviation of the upper chest. */
  private giveWay(): void {
    this.inverse[0] = this.deviation[0] as number;
    for (let i = 1; i < 4; i++) this.inverse[i] = -(this.deviation[i] as number);
    for (const row of LIMBS) multiplyRows(this.inverse, 0, this.pose, row, this.pose, row);
  }

  private noteDeviation(targets: Float64Array, elapsedS: number): void {
    const actual = this.avatar.readAngles();
    this.chest(targets, targets, this.targetChest);
    this.chest(actual, targets, this.actualChest);
    inverseMultiplyRows(this.targetChest, 0, this.actualChest, 0, this.now, 0);
    const share = 1 - Math.exp(-elapsedS / YIELD_S);
    slerpRows(this.deviation, 0, this.now, 0, share, this.deviation, 0);
  }

  /** Write hips_from_chest at these angles; axes without a hinge are at their target. */
  private chest(angles: Float64Array, targets: Float64Array, into: Float64Array): void {
    const { turn } = this;
    into[0] = 1;
    into.fill(0, 1);
    for (const { column, direction } of TRUNK) {
      const angle = angles[column] as number;
      const half = (Number.isNaN(angle) ? (targets[column] as number) : angle) / 2;
      const s = Math.sin(half);
      turn[0] = Math.cos(half);
      for (let i = 0; i < 3; i++) turn[i + 1] = s * (direction[i] as number);
      multiplyRows(into, 0, turn, 0, into, 0);
    }
  }
}
