/**
 * A scripted participant: a body of given stature and span that stands calmly, takes the poses of
 * the calibration, reaches into boxes, steps into boxes on the floor and walks back. It is generated
 * movement, not that of a person, and repeatable: equal seed, times and goals give equal movement.
 *
 * The caller closes the loop: the task's rules judge the remote body, and the caller changes the
 * goal. The server's `app/science/simulation` is the model; what it assumes is listed there.
 *
 * World: +x right, +y up, facing -z, metres.
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
import {
  INDEX,
  JOINTS,
  type JointPlaces,
  jointPlaces,
  placeJoints,
  type Skeleton,
  skeletonOf,
} from "../skeleton";
import { ReachingHand } from "./arms";
import { FeetOfPerson } from "./feet";
import {
  type Aim,
  drawnTraits,
  Follower,
  minimumJerk,
  type ScriptedGoal,
  type Traits,
  unit,
} from "./movements";
import { armRotation, handRotation, legRotation, twoBone } from "./posture";
import { type Random, seeded } from "./random";

/**
 * What the arms do without a goal: hang at ease; hang straight (N-pose); stretch to the sides
 * (T-pose); stretch forwards, palms down; or one arm up, the gesture that stops a session.
 */
export type ArmPose = "ease" | "n_pose" | "t_pose" | "forward" | "left_up" | "right_up";

export interface PersonOptions {
  readonly statureM: number;
  /** From finger tip to finger tip; by default that of the product's skeleton. */
  readonly spanM?: number;
  readonly seed: number;
  /** Where the person stands at first. */
  readonly homeM?: readonly [x: number, z: number];
  readonly traits?: Traits;
  /** Sway, breath and the restless head, as a share of the usual; 0 stands like a statue. */
  readonly restlessness?: number;
}

const SIDES = ["left", "right"] as const;
export type PersonSide = (typeof SIDES)[number];

const LONGEST_FRAME_S = 0.1;
const PRESS_M = 0.012;
const POSE_S = 0.9;
const SOFT_KNEES = 0.985;
const STRAIGHTEST = 0.995;
/** Who is told to stand upright stretches the legs but for this. */
const UPRIGHT = 0.9995;
const SOFT_FROM = 0.95;
const BODY_RATE = 7;
const LEAN_RATE = 6;
const HEIGHT_RATE = 9;
const LOOK_RATE = 8;
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
const SWAY_M = 0.004;
const SWAY_HZ = [0.11, 0.23, 0.41] as const;
const HEAD_RAD = 0.02;
const UP: Vector = [0, 1, 0];
const RIGHTWARDS: Vector = [1, 0, 0];
const BACKWARDS: Vector = [0, 0, 1];
const KNEE_POLE: Vector = [0, 0, -1];
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

export class ScriptedPerson {
  readonly skeleton: Skeleton;
  readonly traits: Traits;
  /** The joints as they are now. */
  readonly joints: JointPlaces = jointPlaces();
  /** The local rotations as they are now, by `INDEX`. */
  readonly local: Quaternion[] = JOINTS.map(() => IDENTITY);
  rootM: Vector;
  /** The delay that the person sees: delayed feedback slows movements. */
  latencyS = 0;
  /** Trigger, or a pinch; and the grip, or a fist. */
  readonly selects: Record<PersonSide, boolean> = { left: false, right: false };
  readonly squeezes: Record<PersonSide, boolean> = { left: false, right: false };
  /** How deep the person squats, 0 to 1. */
  squat = 0;
  private readonly random: Random;
  private readonly phases: readonly number[];
  private readonly restlessness: number;
  private readonly home: readonly [x: number, z: number];
  private readonly feet: FeetOfPerson;
  private readonly hands = [new ReachingHand(), new ReachingHand()] as const;
  private readonly x: Follower;
  private readonly z: Follower;
  private readonly leanX = new Follower(0, LEAN_RATE);
  private readonly leanZ = new Follower(0, LEAN_RATE);
  private readonly height: Follower;
  private readonly yaw = new Follower(0, LOOK_RATE);
  private readonly pitch = new Follower(0, LOOK_RATE);
  private readonly kneel = new Follower(0, 4);
  private arms: { from: ArmPose; to: ArmPose; sinceS: number };
  private hips: readonly [x: number, z: number];
  private lean: readonly [x: number, z: number] = [0, 0];
  private plan: {
    readonly hand: ReachingHand;
    readonly hips: readonly [number, number];
    readonly lean: readonly [number, number];
  } | null = null;
  private goal: ScriptedGoal | null = null;
  private lookM: Vector | null = null;
  private readonly pointsAt: Record<PersonSide, Vector | null> = { left: null, right: null };
  private readonly pointing: Record<PersonSide, number> = { left: 0, right: 0 };
  private readonly guided: Record<PersonSide, Guided | null> = { left: null, right: null };
  private timeS: number | null = null;

  constructor(options: PersonOptions) {
    this.skeleton = skeletonOf(options.statureM, options.spanM);
    this.random = seeded(options.seed);
    this.traits = options.traits ?? drawnTraits(this.random);
    this.restlessness = options.restlessness ?? 1;
    this.phases = Array.from({ length: 12 }, () => 2 * Math.PI * this.random.next());
    this.home = options.homeM ?? [0, 0];
    this.hips = this.home;
    this.feet = new FeetOfPerson(this.skeleton, ...this.home);
    this.x = new Follower(this.home[0], BODY_RATE);
    this.z = new Follower(this.home[1], BODY_RATE);
    this.height = new Follower(SOFT_KNEES * this.skeleton.standingHipsM, HEIGHT_RATE);
    this.arms = { from: "ease", to: "ease", sinceS: -1 };
    this.rootM = [this.home[0], this.height.value, this.home[1]];
    this.advance(0);
    this.timeS = null;
  }

  /** Let the arms take a pose whenever no goal needs them. */
  take(pose: ArmPose): void {
    if (pose === this.arms.to) return;
    this.arms = { from: this.arms.to, to: pose, sinceS: this.timeS ?? 0 };
  }

  /** Look at a point, or straight ahead. */
  lookAt(pointM: Vector | null): void {
    this.lookM = pointM;
  }

  /** Hold a hand up and point at something, such as a row of a panel; null: let it hang again. */
  pointAt(side: PersonSide, pointM: Vector | null): void {
    this.pointsAt[side] = pointM;
  }

  /**
   * Lead a finger tip to a point, fingers along a direction, from now on; null: let go. The hand
   * follows within half a second, as far as the arm reaches.
   */
  guide(side: PersonSide, tipM: Vector | null, fingers: Vector = [0, 0, -1]): void {
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

  /** Whether a step is being made or planned. */
  get isStepping(): boolean {
    return this.feet.isBusy;
  }

  /** Where the body stands: between the ankles. */
  get standsAt(): readonly [x: number, z: number] {
    return this.feet.centre;
  }

  /** Where a hand's ray starts and leads: along the fingers, or to what it points at. */
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

  /** Pursue a goal from now on; null: stand. Setting the same goal again changes nothing. */
  pursue(goal: ScriptedGoal | null): void {
    if (isSame(goal, this.goal)) return;
    const timeS = this.timeS ?? 0;
    this.goal = goal;
    this.plan = null;
    const reactionS = Math.max(0.12, this.traits.reactionS * Math.exp(0.15 * this.random.normal()));
    for (const [side, hand] of this.hands.entries()) {
      if (goal?.kind === "reach" && goal.limb === SIDES[side]) {
        const { hips, lean, settleS } = this.reachPlan(goal, side, hand.fingers);
        hand.setGoal(goal, timeS, reactionS, settleS);
        this.plan = { hand, hips, lean };
      } else if (hand.goal !== null || !hand.isIdle) {
        hand.setGoal(null, timeS, 0);
      }
    }
    const isStepping = goal !== null && goal.kind !== "reach";
    this.feet.setGoal(isStepping ? goal : null, timeS, reactionS);
    if (goal?.kind !== "reach") this.lean = [0, 0];
  }

  /** Move on to a time of the client's clock; call once a frame, in order of time. */
  advance(timeS: number): void {
    const before = this.timeS ?? timeS;
    if (!(timeS >= before)) {
      throw new RangeError(`Time went from ${before} s to ${timeS} s: advance in order of time.`);
    }
    // After a gap the springs must not advance through all of it in one step.
    const stepS = Math.min(timeS - before, LONGEST_FRAME_S);
    this.timeS = timeS;
    this.stand(timeS, stepS);
    placeJoints(this.skeleton, this.rootM, this.local, this.joints);
    for (const side of [0, 1] as const) this.moveArm(side, timeS, stepS);
    placeJoints(this.skeleton, this.rootM, this.local, this.joints);
  }

  /** Place feet, hips, trunk and head. */
  private stand(timeS: number, stepS: number): void {
    const { feet, skeleton, traits, local } = this;
    feet.follow(
      timeS,
      { traits, latencyS: this.latencyS, tempo: traits.footTempo, pressM: 0 },
      this.random,
    );
    // The remote body's hips follow without delay but its arm late: wait until its arm is out.
    if (this.plan !== null && timeS >= this.plan.hand.outS + this.latencyS) {
      this.hips = this.plan.hips;
      this.lean = this.plan.lean;
      this.plan = null;
    }
    const [goalX, goalZ] = this.hipsGoal();
    const x = this.x.follow(goalX, stepS) + this.wave(0, timeS) * SWAY_M;
    const z = this.z.follow(goalZ, stepS) + this.wave(3, timeS) * SWAY_M;
    this.bendTrunk(this.leanX.follow(this.lean[0], stepS), this.leanZ.follow(this.lean[1], stepS));
    this.turnHead(timeS, stepS, [x, z]);
    const ankles = [
      feet.ankle(0, skeleton.ankleHeightM),
      feet.ankle(1, skeleton.ankleHeightM),
    ] as const;
    const low = this.kneel.follow(this.squat, stepS);
    const isUpright = this.goal === null && this.arms.to !== "ease";
    const knees = isUpright ? 1 : SOFT_KNEES;
    const wanted = (knees - 0.3 * low) * skeleton.standingHipsM;
    const highest = this.highestHips(x, z, ankles, isUpright ? UPRIGHT : STRAIGHTEST);
    const height = Math.min(this.height.follow(Math.min(wanted, highest), stepS), highest);
    // A person who squats moves the hips back and leans forwards, or would fall.
    this.rootM = [x, height, z + 0.12 * low];
    local[0] = IDENTITY;
    this.placeLegs(ankles);
  }

  private hipsGoal(): readonly [x: number, z: number] {
    const [mx, mz] = this.feet.centre;
    if (this.goal?.kind === "reach") {
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

  /** Bend the three joints of the spine so that the shoulders move by about (x, z). */
  private bendTrunk(x: number, z: number): void {
    const trunkM = 0.818 * this.skeleton.statureM - this.skeleton.standingHipsM;
    const forwards = -0.35 * this.kneel.value;
    const bend = multiply(
      turned(RIGHTWARDS, z / trunkM / 3 + forwards / 3),
      turned(BACKWARDS, -x / trunkM / 3),
    );
    for (const joint of [INDEX.Spine, INDEX.Chest, INDEX.UpperChest]) this.local[joint] = bend;
  }

  private turnHead(timeS: number, stepS: number, [x, z]: readonly [number, number]): void {
    let yaw = 0;
    let pitch = 0;
    if (this.lookM !== null) {
      const eyes = 0.94 * this.skeleton.statureM;
      const [dx, dy, dz] = minus(this.lookM, [x, eyes, z]);
      yaw = Math.min(1.2, Math.max(-1.2, Math.atan2(-dx, -dz)));
      pitch = Math.min(0.7, Math.max(-0.7, Math.atan2(dy, Math.hypot(dx, dz))));
    }
    const own = HEAD_RAD * this.wave(6, timeS);
    const nod = HEAD_RAD * this.wave(9, timeS);
    const half = multiply(
      turned(UP, (this.yaw.follow(yaw, stepS) + own) / 2),
      turned(RIGHTWARDS, (this.pitch.follow(pitch, stepS) + nod + 0.35 * this.kneel.value) / 2),
    );
    this.local[INDEX.Neck] = half;
    this.local[INDEX.Head] = half;
  }

  /** A sum of slow sines with a standard deviation of about 1, times the restlessness. */
  private wave(first: number, timeS: number): number {
    let sum = 0;
    for (const [index, hz] of SWAY_HZ.entries()) {
      sum += Math.sin(2 * Math.PI * hz * timeS + (this.phases[first + index] as number));
    }
    return this.restlessness * sum * Math.sqrt(2 / SWAY_HZ.length);
  }

  private highestHips(
    x: number,
    z: number,
    ankles: readonly [Vector, Vector],
    straightest: number,
  ): number {
    const legM = straightest * (this.skeleton.thighM + this.skeleton.shankM);
    return Math.min(
      ...[INDEX.LeftUpperLeg, INDEX.RightUpperLeg].map((joint, side) => {
        const [sx, sy, sz] = this.skeleton.offsetsM[joint] as Vector;
        const [ax, ay, az] = ankles[side] as Vector;
        const away = (ax - x - sx) ** 2 + (az - z - sz) ** 2;
        return ay - sy + Math.sqrt(Math.max(legM * legM - away, 0));
      }),
    );
  }

  /** Knees forward, feet flat and straight ahead. */
  private placeLegs(ankles: readonly [Vector, Vector]): void {
    const { skeleton, local } = this;
    for (const [side, first] of [INDEX.LeftUpperLeg, INDEX.RightUpperLeg].entries()) {
      const socket = plus(this.rootM, skeleton.offsetsM[first] as Vector);
      const limb = twoBone(
        socket,
        ankles[side] as Vector,
        skeleton.thighM,
        skeleton.shankM,
        KNEE_POLE,
      );
      const upper = legRotation(limb.upper, limb.normal);
      const lower = legRotation(limb.lower, limb.normal);
      local[first] = upper;
      local[first + 1] = multiply(conjugate(upper), lower);
      local[first + 2] = conjugate(lower);
      local[first + 3] = IDENTITY;
    }
  }

  private moveArm(side: 0 | 1, timeS: number, stepS: number): void {
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
    if (!hand.isIdle) {
      const tipM = hand.work === 0 ? this.tipOf(arm, side, shoulderM, turn) : hand.tipM;
      const aim: Aim = { traits: this.traits, latencyS: this.latencyS, tempo: 1, pressM: PRESS_M };
      hand.follow(timeS, stepS, tipM, aim, this.random);
      if (hand.work > 0) {
        const { solved, missingM } = this.reached(side, shoulderM, turn, hand);
        arm = mixed(arm, solved, hand.work);
        if (hand.goal !== null) this.catchUp(missingM, stepS);
      }
    }
    for (const [index, rotation] of arm.entries()) this.local[first + index] = rotation;
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

  /** The smallest shift from home with which the arm reaches, partly by leaning. */
  private reachPlan(
    goal: ScriptedGoal,
    side: number,
    fingers: Vector,
  ): { hips: readonly [number, number]; lean: readonly [number, number]; settleS: number } {
    const { statureM, upperArmM, forearmM, handM } = this.skeleton;
    const armM = upperArmM + forearmM;
    const [homeX, homeZ] = this.home;
    const wrist = minus(goal.targetM, times(fingers, handM));
    let dx = wrist[0] - (homeX + (side === 0 ? -1 : 1) * 0.129 * statureM);
    const dy = wrist[1] - SOFT_KNEES * 0.818 * statureM;
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
  private catchUp(missingM: Vector, stepS: number): void {
    const size = Math.hypot(missingM[0], missingM[2]);
    if (size < 1e-9) return;
    // A little more than is missing, or the last millimetre would never be covered.
    const share = (Math.min(1, CATCH_UP_RATE * stepS) * (size + 0.01)) / size;
    const [x, z] = [this.hips[0] + share * missingM[0], this.hips[1] + share * missingM[2]];
    if (Math.hypot(x - this.home[0], z - this.home[1]) <= MOST_SHIFT_M) this.hips = [x, z];
  }
}

function isSame(a: ScriptedGoal | null, b: ScriptedGoal | null): boolean {
  if (a === null || b === null) return a === b;
  return (
    a.kind === b.kind &&
    a.limb === b.limb &&
    a.targetM.every((value, axis) => value === b.targetM[axis]) &&
    a.approachM.every((value, axis) => value === b.approachM[axis])
  );
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

/** The shift across a deep opening's axis that lets the arm enter nearly straight. */
function inFront(dx: number, dz: number, [ax, , az]: Vector): readonly [x: number, z: number] {
  const depth = Math.hypot(ax, az);
  if (depth < DEEP_M) return [0, 0];
  const [sideX, sideZ] = [-az / depth, ax / depth];
  const offset = dx * sideX + dz * sideZ;
  const excess = Math.max(Math.abs(offset) - ASLANT_M, 0) * Math.sign(offset);
  return [excess * sideX, excess * sideZ];
}

/** How far an arm stretches: exactly up to 95 % of its length, beyond it ever more slowly. */
function softReach(awayM: number, armM: number): number {
  const softM = SOFT_FROM * armM;
  if (awayM <= softM) return awayM;
  const roomM = armM - softM;
  return armM - roomM * Math.exp((softM - awayM) / roomM);
}
