/**
 * Where a scripted person goes: the steps of the feet, and how far the hips shift and lean for a
 * reach, partly ahead of the feet and then with a side step.
 */
import { minus, times, type Vector } from "@shared/rotations";
import type { Skeleton } from "../skeleton";
import type { ReachingHand } from "./arms";
import { FeetOfPerson } from "./feet";
import type { ScriptedGoal, Traits } from "./movements";
import type { Random } from "./random";

const REACH_SHARE = 0.89;
const NEAREST_SHARE = 0.45;
const LEAN_SHARE = 0.5;
const MOST_LEAN_M = 0.1;
const MOST_SHIFT_M = 0.7;
const STEP_AFTER_M = 0.12;
const MOST_AHEAD_M = 0.25;
const DEEP_M = 0.15;
const ASLANT_M = 0.12;
const CATCH_UP_RATE = 3;
const BEARING_SHARE = 0.65;
/** Height of the shoulders while the knees are soft, as a share of the stature. */
const SHOULDER_SHARE = 0.985 * 0.818;

type OnFloor = readonly [x: number, z: number];

export class Stepping {
  /** How far the shoulders are to lean ahead of the hips. */
  lean: OnFloor = [0, 0];
  private readonly skeleton: Skeleton;
  private readonly home: OnFloor;
  private readonly feet: FeetOfPerson;
  private hips: OnFloor;
  private plan: {
    readonly hand: ReachingHand;
    readonly hips: OnFloor;
    readonly lean: OnFloor;
  } | null = null;

  constructor(skeleton: Skeleton, home: OnFloor) {
    this.skeleton = skeleton;
    this.home = home;
    this.hips = home;
    this.feet = new FeetOfPerson(skeleton, ...home);
  }

  /** Whether a step is being made or planned. */
  get isBusy(): boolean {
    return this.feet.isBusy;
  }

  /** Between the ankles. */
  get centre(): OnFloor {
    return this.feet.centre;
  }

  get ankles(): readonly [Vector, Vector] {
    const { ankleHeightM } = this.skeleton;
    return [this.feet.ankle(0, ankleHeightM), this.feet.ankle(1, ankleHeightM)];
  }

  /** Forget what was planned for the goal before. */
  replan(): void {
    this.plan = null;
  }

  /** Pursue a goal with the feet; null or a reach: they stand. */
  setGoal(goal: ScriptedGoal | null, timeS: number, reactionS: number): void {
    const isReaching = goal?.kind === "reach";
    this.feet.setGoal(isReaching ? null : goal, timeS, reactionS);
    if (!isReaching) this.lean = [0, 0];
  }

  /** Shift for a reach as soon as the hand is out. */
  shiftFor(hand: ReachingHand, { hips, lean }: Pick<Shift, "hips" | "lean">): void {
    this.plan = { hand, hips, lean };
  }

  /** Move the feet on; call once a frame. */
  follow(timeS: number, traits: Traits, latencyS: number, random: Random): void {
    this.feet.follow(timeS, { traits, latencyS, tempo: traits.footTempo, pressM: 0 }, random);
    // The remote body's hips follow without delay but its arm late: wait until its arm is out.
    if (this.plan !== null && timeS >= this.plan.hand.outS + latencyS) {
      this.hips = this.plan.hips;
      this.lean = this.plan.lean;
      this.plan = null;
    }
  }

  /** Where the hips are to be; a reach that leads too far from the feet makes them step aside. */
  hipsGoal(isReaching: boolean): OnFloor {
    const [mx, mz] = this.feet.centre;
    if (isReaching) {
      const [x, z] = this.hips;
      const ahead = Math.hypot(x - mx, z - mz);
      if (ahead > STEP_AFTER_M) this.feet.sideStep(x, z);
      const share = Math.min(1, MOST_AHEAD_M / Math.max(ahead, 1e-9));
      return [mx + share * (x - mx), mz + share * (z - mz)];
    }
    const foot = this.feet.bearingFoot;
    if (foot === null) return [mx, mz];
    const [x, , z] = this.feet.ankle(foot, 0);
    const share = 2 * BEARING_SHARE - 1;
    return [mx + share * (x - mx), mz + share * (z - mz)];
  }

  /** The smallest shift from home with which the arm reaches, partly by leaning. */
  shift(goal: ScriptedGoal, side: number, fingers: Vector): Shift {
    const { statureM, upperArmM, forearmM, handM } = this.skeleton;
    const armM = upperArmM + forearmM;
    const [homeX, homeZ] = this.home;
    const wrist = minus(goal.targetM, times(fingers, handM));
    let dx = wrist[0] - (homeX + (side === 0 ? -1 : 1) * 0.129 * statureM);
    const dy = wrist[1] - SHOULDER_SHARE * statureM;
    let dz = wrist[2] - homeZ;
    const [frontX, frontZ] = inFront(dx, dz, goal.approachM);
    dx -= frontX;
    dz -= frontZ;
    const away = Math.max(Math.hypot(dx, dz), 1e-6);
    const reach = REACH_SHARE * armM;
    const farthest = Math.sqrt(Math.max(reach * reach - dy * dy, (0.2 * reach) ** 2));
    const nearest = Math.min(NEAREST_SHARE * armM, farthest);
    const excess = away > farthest ? away - farthest : Math.min(away - nearest, 0);
    const lean = Math.min(Math.max(LEAN_SHARE * excess, 0), MOST_LEAN_M);
    const shift = [
      frontX + ((excess - lean) * dx) / away,
      frontZ + ((excess - lean) * dz) / away,
    ] as const;
    const scale = Math.min(1, MOST_SHIFT_M / Math.max(Math.hypot(...shift), 1e-6));
    const hips = [homeX + scale * shift[0], homeZ + scale * shift[1]] as const;
    const wayM = Math.hypot(hips[0] - this.hips[0], hips[1] - this.hips[1]);
    return {
      hips,
      lean: [(lean * dx) / away, (lean * dz) / away],
      settleS: wayM > 0.03 ? 0.25 + wayM : 0,
    };
  }

  /** Move nearer while a hand falls short of its goal. */
  catchUp(missingM: Vector, stepS: number): void {
    const size = Math.hypot(missingM[0], missingM[2]);
    if (size < 1e-9) return;
    // A little more than is missing, or the last millimetre would never be covered.
    const share = (Math.min(1, CATCH_UP_RATE * stepS) * (size + 0.01)) / size;
    const [x, z] = [this.hips[0] + share * missingM[0], this.hips[1] + share * missingM[2]];
    if (Math.hypot(x - this.home[0], z - this.home[1]) <= MOST_SHIFT_M) this.hips = [x, z];
  }
}

/** Where the hips go for a reach, and how long the body takes to come to rest there. */
export interface Shift {
  readonly hips: OnFloor;
  readonly lean: OnFloor;
  readonly settleS: number;
}

/** The shift across a deep opening's axis that lets the arm enter nearly straight. */
function inFront(dx: number, dz: number, [ax, , az]: Vector): readonly [x: number, z: number] {
  const depth = Math.hypot(ax, az);
  if (depth < DEEP_M) return [0, 0];
  const [sideX, sideZ] = [-az / depth, ax / depth];
  const offset = dx * sideX + dz * sideZ;
  const excess = Math.max(Math.abs(offset) - ASLANT_M, 0) * Math.sign(offset);
  return [excess * sideX, excess * sideZ];
}
