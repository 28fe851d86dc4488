/**
 * What the arms of a scripted person do: take a pose, point at something, follow a hand that is led
 * from outside, or reach for a goal.
 */
import {
  length,
  minus,
  multiply,
  plus,
  type Quaternion,
  rotate,
  times,
  type Vector,
} from "@shared/rotations";
import { blendedRotation, conjugate, turned } from "../places";
import { INDEX, type JointPlaces, type Skeleton } from "../skeleton";
import { ReachingHand } from "./arms";
import { type Aim, Follower, minimumJerk, type Traits, unit } from "./movements";
import { armRotation, handRotation, twoBone } from "./posture";
import type { Random } from "./random";

/**
 * What the arms do without a goal: hang at ease; hang straight (N-pose); stretch to the sides
 * (T-pose); stretch forwards, palms down; or one arm up, the gesture that stops a session.
 */
export type ArmPose = "ease" | "n_pose" | "t_pose" | "forward" | "left_up" | "right_up";

export const SIDES = ["left", "right"] as const;
export type PersonSide = (typeof SIDES)[number];

const PRESS_M = 0.012;
const POSE_S = 0.9;
const SOFT_FROM = 0.95;
const UP: Vector = [0, 1, 0];
const BACKWARDS: Vector = [0, 0, 1];
const IDENTITY: Quaternion = [1, 0, 0, 0];
const DEGREES = Math.PI / 180;
const GUIDE_RATE = 10;
const GUIDE_S = 0.5;

/** A hand that somebody leads from outside, such as with a mouse. */
interface Guided {
  tipM: Vector;
  fingers: Vector;
  /** Where the fingers point now, on their way to `fingers`. */
  along: Vector;
  readonly axes: readonly [Follower, Follower, Follower];
  share: number;
  isHeld: boolean;
}

/** Rotations of upper arm, lower arm and hand in the shoulder's frame, for one side. */
type Arm = readonly [upper: Quaternion, lower: Quaternion, hand: Quaternion];

/** One frame, and how the person moves. */
export interface ArmFrame {
  readonly timeS: number;
  readonly stepS: number;
  readonly traits: Traits;
  readonly latencyS: number;
  readonly random: Random;
}

export class Reaching {
  readonly hands = [new ReachingHand(), new ReachingHand()] as const;
  private readonly skeleton: Skeleton;
  private readonly joints: JointPlaces;
  private readonly local: Quaternion[];
  private arms: { from: ArmPose; to: ArmPose; sinceS: number } = {
    from: "ease",
    to: "ease",
    sinceS: -1,
  };
  private readonly pointsAt: Record<PersonSide, Vector | null> = { left: null, right: null };
  private readonly pointing: Record<PersonSide, number> = { left: 0, right: 0 };
  private readonly guided: Record<PersonSide, Guided | null> = { left: null, right: null };

  /** `joints`: those of the whole body; `local`: its rotations, of which the arms' are written. */
  constructor(skeleton: Skeleton, joints: JointPlaces, local: Quaternion[]) {
    this.skeleton = skeleton;
    this.joints = joints;
    this.local = local;
  }

  /** What the arms do without a goal. */
  get pose(): ArmPose {
    return this.arms.to;
  }

  take(pose: ArmPose, timeS: number): void {
    if (pose === this.arms.to) return;
    this.arms = { from: this.arms.to, to: pose, sinceS: timeS };
  }

  pointAt(side: PersonSide, pointM: Vector | null): void {
    this.pointsAt[side] = pointM;
  }

  guide(side: PersonSide, tipM: Vector | null, fingers: Vector): void {
    const guided = this.guided[side];
    if (tipM === null) {
      if (guided !== null) guided.isHeld = false;
      return;
    }
    if (guided === null) {
      const hand = INDEX[side === "left" ? "LeftHand" : "RightHand"];
      const from = this.joints.positionsM[hand] as Vector;
      const axis = (at: 0 | 1 | 2) => new Follower(from[at], GUIDE_RATE);
      const axes = [axis(0), axis(1), axis(2)] as const;
      this.guided[side] = { tipM, fingers, along: fingers, axes, share: 0, isHeld: true };
      return;
    }
    guided.tipM = tipM;
    guided.fingers = fingers;
    guided.isHeld = true;
  }

  rayOf(side: PersonSide): { readonly originM: Vector; readonly direction: Vector } {
    const at = this.pointsAt[side];
    const hand = INDEX[side === "left" ? "LeftHand" : "RightHand"];
    const originM = this.joints.positionsM[hand] as Vector;
    const fingers: Vector = [side === "left" ? -1 : 1, 0, 0];
    if (at === null)
      return { originM, direction: rotate(this.joints.rotations[hand] as Quaternion, fingers) };
    const line = minus(at, originM);
    return { originM, direction: times(line, 1 / Math.max(length(line), 1e-9)) };
  }

  /** Move an arm on, once the shoulders are placed; what its hand falls short of its goal by. */
  move(side: 0 | 1, { timeS, stepS, traits, latencyS, random }: ArmFrame): Vector | null {
    const name = SIDES[side];
    const first = side === 0 ? INDEX.LeftUpperArm : INDEX.RightUpperArm;
    const shoulderM = this.joints.positionsM[first] as Vector;
    const turn = this.joints.rotations[first - 1] as Quaternion;
    let arm = this.posed(name, timeS);
    const at = this.pointsAt[name];
    const change = stepS / 0.4;
    this.pointing[name] = Math.min(
      1,
      Math.max(0, this.pointing[name] + (at === null ? -change : change)),
    );
    if (this.pointing[name] > 0) {
      const share = minimumJerk(this.pointing[name]);
      arm = mixed(arm, this.towards(name, shoulderM, turn, at), share);
    }
    arm = this.guidedArm(name, side, arm, shoulderM, turn, stepS);
    const hand = this.hands[side];
    let shortM: Vector | null = null;
    if (!hand.isIdle) {
      const tipM = hand.work === 0 ? this.tipOf(arm, side, shoulderM, turn) : hand.tipM;
      const aim: Aim = { traits, latencyS, tempo: 1, pressM: PRESS_M };
      hand.follow(timeS, stepS, tipM, aim, random);
      if (hand.work > 0) {
        const { solved, missingM } = this.reached(side, shoulderM, turn, hand);
        arm = mixed(arm, solved, hand.work);
        if (hand.goal !== null) shortM = missingM;
      }
    }
    for (const [index, rotation] of arm.entries()) this.local[first + index] = rotation;
    return shortM;
  }

  /** The arm led to where its hand is guided; it lets go and engages within half a second. */
  private guidedArm(
    name: PersonSide,
    side: 0 | 1,
    arm: Arm,
    shoulderM: Vector,
    turn: Quaternion,
    stepS: number,
  ): Arm {
    const guided = this.guided[name];
    if (guided === null) return arm;
    const change = stepS / GUIDE_S;
    guided.share = Math.min(1, Math.max(0, guided.share + (guided.isHeld ? change : -change)));
    const { axes, tipM, isHeld } = guided;
    // A hand turns no faster than it moves, however suddenly its fingers are told to.
    const turnShare = Math.min(1, GUIDE_RATE * stepS);
    const mean = plus(times(guided.along, 1 - turnShare), times(guided.fingers, turnShare));
    guided.along = unit(mean, guided.fingers);
    const fingers = guided.along;
    const followed: Vector = [
      axes[0].follow(tipM[0], stepS),
      axes[1].follow(tipM[1], stepS),
      axes[2].follow(tipM[2], stepS),
    ];
    const wristM = minus(followed, times(fingers, this.skeleton.handM));
    const { solved } = this.stretched(side, shoulderM, turn, wristM, fingers);
    if (!isHeld && guided.share === 0) this.guided[name] = null;
    return mixed(arm, solved, minimumJerk(guided.share));
  }

  /** The arm in the pose that it takes, or on its way to it. */
  private posed(side: PersonSide, timeS: number): Arm {
    const { from, to, sinceS } = this.arms;
    const share = sinceS < 0 ? 1 : minimumJerk((timeS - sinceS) / POSE_S);
    return share >= 1 ? armIn(to, side) : mixed(armIn(from, side), armIn(to, side), share);
  }

  /** An arm half stretched in front of the chest, fingers towards a point. */
  private towards(side: PersonSide, shoulderM: Vector, turn: Quaternion, at: Vector | null): Arm {
    const { upperArmM, forearmM } = this.skeleton;
    const armM = upperArmM + forearmM;
    const wristM = plus(shoulderM, [side === "left" ? 0.02 : -0.02, -0.4 * armM, -0.62 * armM]);
    const line = minus(at ?? plus(wristM, [0, 0, -1]), wristM);
    return this.solved(
      side === "left" ? 0 : 1,
      shoulderM,
      turn,
      wristM,
      times(line, 1 / Math.max(length(line), 1e-9)),
    );
  }

  /** The arm that brings the finger tip to where the hand wants it, and what is missing. */
  private reached(
    side: 0 | 1,
    shoulderM: Vector,
    turn: Quaternion,
    hand: ReachingHand,
  ): { solved: Arm; missingM: Vector } {
    const wristM = minus(hand.tipM, times(hand.fingers, this.skeleton.handM));
    return this.stretched(side, shoulderM, turn, wristM, hand.fingers);
  }

  /** The arm that brings the wrist to a place, or as near as it gets, and what is missing. */
  private stretched(
    side: 0 | 1,
    shoulderM: Vector,
    turn: Quaternion,
    wristM: Vector,
    fingers: Vector,
  ): { solved: Arm; missingM: Vector } {
    const { upperArmM, forearmM } = this.skeleton;
    const way = minus(wristM, shoulderM);
    const awayM = Math.max(length(way), 1e-9);
    const reachM = softReach(awayM, upperArmM + forearmM);
    const reachedM = plus(shoulderM, times(way, reachM / awayM));
    const solved = this.solved(side, shoulderM, turn, reachedM, fingers);
    return { solved, missingM: times(way, (awayM - reachM) / awayM) };
  }

  private solved(
    side: 0 | 1,
    shoulderM: Vector,
    turn: Quaternion,
    wristM: Vector,
    fingers: Vector,
  ): Arm {
    const sign = side === 0 ? -1 : 1;
    const { upperArmM, forearmM } = this.skeleton;
    const limb = twoBone(shoulderM, wristM, upperArmM, forearmM, [0.35 * sign, -1, 0.25]);
    const upper = armRotation(limb.upper, limb.normal, sign);
    const lower = armRotation(limb.lower, limb.normal, sign);
    const hand = handRotation(fingers, limb.normal, sign);
    return [
      multiply(conjugate(turn), upper),
      multiply(conjugate(upper), lower),
      multiply(conjugate(lower), hand),
    ];
  }

  private tipOf(
    [upper, lower, hand]: Arm,
    side: 0 | 1,
    shoulderM: Vector,
    turn: Quaternion,
  ): Vector {
    const { upperArmM, forearmM, handM } = this.skeleton;
    const along = (lengthM: number): Vector => [side === 0 ? -lengthM : lengthM, 0, 0];
    const ofUpper = multiply(turn, upper);
    const ofLower = multiply(ofUpper, lower);
    const elbow = plus(shoulderM, rotate(ofUpper, along(upperArmM)));
    const wrist = plus(elbow, rotate(ofLower, along(forearmM)));
    return plus(wrist, rotate(multiply(ofLower, hand), along(handM)));
  }
}

const mixed = (a: Arm, b: Arm, share: number): Arm => [
  blendedRotation(a[0], b[0], share),
  blendedRotation(a[1], b[1], share),
  blendedRotation(a[2], b[2], share),
];

/** The left arm is the right one's mirror image in the plane between them. */
function armIn(pose: ArmPose, side: PersonSide): Arm {
  const sign = side === "left" ? 1 : -1;
  const lowered = (degrees: number): Quaternion => turned(BACKWARDS, sign * degrees * DEGREES);
  const swung = (degrees: number): Quaternion => turned(UP, -sign * degrees * DEGREES);
  switch (pose) {
    case "t_pose":
      return [IDENTITY, IDENTITY, IDENTITY];
    case "n_pose":
      return [lowered(90), IDENTITY, IDENTITY];
    case "forward":
      return [swung(90), IDENTITY, IDENTITY];
    case "left_up":
    case "right_up":
      return pose === `${side}_up` ? [lowered(-80), IDENTITY, IDENTITY] : armIn("ease", side);
    case "ease":
      return [lowered(78), swung(18), IDENTITY];
  }
}

/** How far an arm stretches: exactly up to 95 % of its length, beyond it ever more slowly. */
function softReach(awayM: number, armM: number): number {
  const softM = SOFT_FROM * armM;
  if (awayM <= softM) return awayM;
  const roomM = armM - softM;
  return armM - roomM * Math.exp((softM - awayM) / roomM);
}
