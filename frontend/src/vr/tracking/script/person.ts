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
import type { Quaternion, Vector } from "@shared/rotations";
import {
  JOINTS,
  type JointPlaces,
  jointPlaces,
  placeJoints,
  type Skeleton,
  skeletonOf,
} from "../skeleton";
import { drawnTraits, type ScriptedGoal, type Traits } from "./movements";
import { type Random, seeded } from "./random";
import { type ArmPose, type PersonSide, Reaching, SIDES } from "./reaching";
import { Standing } from "./standing";
import { Stepping } from "./stepping";

export type { ArmPose, PersonSide } from "./reaching";

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

const LONGEST_FRAME_S = 0.1;
const IDENTITY: Quaternion = [1, 0, 0, 0];
const AHEAD: Vector = [0, 0, -1];

export class ScriptedPerson {
  readonly skeleton: Skeleton;
  readonly traits: Traits;
  /** The joints as they are now. */
  readonly joints: JointPlaces = jointPlaces();
  /** The local rotations as they are now, by `INDEX`. */
  readonly local: Quaternion[] = JOINTS.map(() => IDENTITY);
  /** The delay that the person sees: delayed feedback slows movements. */
  latencyS = 0;
  /** Trigger, or a pinch; and the grip, or a fist. */
  readonly selects: Record<PersonSide, boolean> = { left: false, right: false };
  readonly squeezes: Record<PersonSide, boolean> = { left: false, right: false };
  /** How deep the person squats, 0 to 1. */
  squat = 0;
  private readonly random: Random;
  private readonly standing: Standing;
  private readonly reaching: Reaching;
  private readonly stepping: Stepping;
  private goal: ScriptedGoal | null = null;
  private lookM: Vector | null = null;
  private timeS: number | null = null;

  constructor(options: PersonOptions) {
    const { restlessness = 1, homeM: home = [0, 0] } = options;
    this.skeleton = skeletonOf(options.statureM, options.spanM);
    this.random = seeded(options.seed);
    this.traits = options.traits ?? drawnTraits(this.random);
    const { skeleton, local, joints, random } = this;
    this.standing = new Standing(skeleton, local, home, restlessness, random);
    this.reaching = new Reaching(skeleton, joints, local);
    this.stepping = new Stepping(skeleton, home);
    this.advance(0);
    this.timeS = null;
  }

  get rootM(): Vector {
    return this.standing.rootM;
  }

  /** Let the arms take a pose whenever no goal needs them. */
  take(pose: ArmPose): void {
    this.reaching.take(pose, this.timeS ?? 0);
  }

  /** Look at a point, or straight ahead. */
  lookAt(pointM: Vector | null): void {
    this.lookM = pointM;
  }

  /** Hold a hand up and point at something, such as a row of a panel; null: let it hang again. */
  pointAt(side: PersonSide, pointM: Vector | null): void {
    this.reaching.pointAt(side, pointM);
  }

  /**
   * Lead a finger tip to a point, fingers along a direction, from now on; null: let go. The hand
   * follows within half a second, as far as the arm reaches.
   */
  guide(side: PersonSide, tipM: Vector | null, fingers: Vector = AHEAD): void {
    this.reaching.guide(side, tipM, fingers);
  }

  /** Whether a step is being made or planned. */
  get isStepping(): boolean {
    return this.stepping.isBusy;
  }

  /** Where the body stands: between the ankles. */
  get standsAt(): readonly [x: number, z: number] {
    return this.stepping.centre;
  }

  /** Where a hand's ray starts and leads: along the fingers, or to what it points at. */
  rayOf(side: PersonSide): { readonly originM: Vector; readonly direction: Vector } {
    return this.reaching.rayOf(side);
  }

  /** Pursue a goal from now on; null: stand. Setting the same goal again changes nothing. */
  pursue(goal: ScriptedGoal | null): void {
    if (isSame(goal, this.goal)) return;
    const { reaching, stepping } = this;
    const timeS = this.timeS ?? 0;
    this.goal = goal;
    stepping.replan();
    const reactionS = Math.max(0.12, this.traits.reactionS * Math.exp(0.15 * this.random.normal()));
    for (const [side, hand] of reaching.hands.entries()) {
      if (goal?.kind === "reach" && goal.limb === SIDES[side]) {
        const shift = stepping.shift(goal, side, hand.fingers);
        hand.setGoal(goal, timeS, reactionS, shift.settleS);
        stepping.shiftFor(hand, shift);
      } else if (hand.goal !== null || !hand.isIdle) {
        hand.setGoal(null, timeS, 0);
      }
    }
    stepping.setGoal(goal, timeS, reactionS);
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
    const { traits, latencyS, random } = this;
    for (const side of [0, 1] as const) {
      const shortM = this.reaching.move(side, { timeS, stepS, traits, latencyS, random });
      if (shortM !== null) this.stepping.catchUp(shortM, stepS);
    }
    placeJoints(this.skeleton, this.rootM, this.local, this.joints);
  }

  /** Place feet, hips, trunk and head. */
  private stand(timeS: number, stepS: number): void {
    const { goal, stepping, standing, lookM, squat } = this;
    stepping.follow(timeS, this.traits, this.latencyS, this.random);
    const hips = stepping.hipsGoal(goal?.kind === "reach");
    const { lean, ankles } = stepping;
    const isUpright = goal === null && this.reaching.pose !== "ease";
    standing.stand({ timeS, stepS, hips, lean, ankles, lookM, squat, isUpright });
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
