/**
 * Two feet that stand or step, and the plan of their steps: the server's
 * `app/science/simulation/{stance,steps}.py`.
 *
 * A foot's position is the middle of its sole. Both stay within a comfortable stride of each other.
 */
import type { Vector } from "@shared/rotations";
import type { Skeleton } from "../skeleton";
import { type Aim, aimedPath, pathThrough, type ScriptedGoal, type SmoothPath } from "./movements";
import type { Random } from "./random";

type Feet = readonly [Vector, Vector];
interface Step {
  readonly foot: number;
  readonly place: Vector;
}

const MOST_STEPS = 60;
const ARRIVED_M = 0.01;
const FOLLOW_SHARE = 0.97;
const LEAST_LIFT_M = 0.06;
const STEP_S = 0.35;
const STEP_S_PER_M = 0.45;
const STILL: Vector = [0, 0, 0];

const onFloorM = (a: Vector, b: Vector): number => Math.hypot(a[0] - b[0], a[2] - b[2]);

export class FeetOfPerson {
  soles: [Vector, Vector] = [STILL, STILL];
  goal: ScriptedGoal | null = null;
  private readonly halfWidthM: number;
  private readonly soleAheadM: number;
  private readonly strideM: number;
  private edges: [Vector, Vector] = [STILL, STILL];
  private swing: { readonly foot: number; readonly path: SmoothPath } | null = null;
  private queue: Step[] = [];
  private pending: ScriptedGoal | null = null;
  private reactS = 0;
  private sinceS = 0;
  /** Places that a foot has stepped into are free of edges: the other foot may use them too. */
  private readonly boxes = new Map<string, { readonly place: Vector; readonly edge: Vector }>();

  constructor({ statureM, thighM, shankM }: Skeleton, x: number, z: number) {
    this.halfWidthM = 0.055 * statureM;
    // The ankle is a quarter of the foot's length (.152 H) from the heel: the middle is ahead.
    this.soleAheadM = 0.038 * statureM;
    this.strideM = 0.72 * (thighM + shankM);
    this.placeAt(x, z);
  }

  /** Put both feet on the floor under a body, without stepping. */
  placeAt(x: number, z: number): void {
    this.soles = [...this.places([x, 0, z])];
    this.edges = [STILL, STILL];
    this.swing = null;
    this.queue = [];
    this.pending = null;
  }

  get isBusy(): boolean {
    return this.swing !== null || this.queue.length > 0 || this.pending !== null;
  }

  /** The foot that bears the weight: the standing or last moved one; null for both. */
  get bearingFoot(): number | null {
    if (this.swing !== null) return 1 - this.swing.foot;
    return this.goal?.kind === "step" ? footOf(this.goal) : null;
  }

  /** The midpoint between the ankles. */
  get centre(): readonly [x: number, z: number] {
    const [left, right] = this.soles;
    return [(left[0] + right[0]) / 2, (left[2] + right[2]) / 2 + this.soleAheadM];
  }

  ankle(foot: number, heightM: number): Vector {
    const [x, y, z] = this.soles[foot] as Vector;
    return [x, y + heightM, z + this.soleAheadM];
  }

  /** Step or walk after a reaction time; null: stay. */
  setGoal(goal: ScriptedGoal | null, timeS: number, reactionS: number): void {
    this.pending = goal;
    this.reactS = timeS + reactionS;
    this.queue = [];
    if (goal === null) this.goal = null;
  }

  /** Step so that the body stands at (x, z), unless steps are in progress. */
  sideStep(x: number, z: number): void {
    if (!this.isBusy) this.queue = stepsToStand(this.soles, this.places([x, 0, z]), this.strideM);
  }

  follow(timeS: number, aim: Aim, random: Random): void {
    if (this.swing !== null) {
      const { foot, path } = this.swing;
      this.soles[foot] = path.at(timeS);
      if (timeS < path.endS) return;
      this.swing = null;
      this.sinceS = timeS;
    }
    if (this.pending !== null && timeS >= this.reactS) {
      this.goal = this.pending;
      this.pending = null;
      this.plan(this.goal);
    } else if (this.goal !== null && this.isRetryDue(timeS, aim)) {
      this.plan(this.goal);
    }
    const next = this.queue.shift();
    if (next !== undefined) this.liftOff(next, timeS, aim, random);
  }

  private places([x, y, z]: Vector): Feet {
    const ahead = z - this.soleAheadM;
    return [
      [x - this.halfWidthM, y, ahead],
      [x + this.halfWidthM, y, ahead],
    ];
  }

  private plan(goal: ScriptedGoal): void {
    if (goal.kind !== "step") {
      this.queue = stepsToStand(this.soles, this.places(goal.targetM), this.strideM);
      return;
    }
    const spots = [...this.boxes.values()].map(({ place }) => place);
    this.queue = stepsOnto(this.soles, footOf(goal), goal.targetM, this.strideM, spots);
    if (goal.approachM[1] > LEAST_LIFT_M) {
      this.boxes.set(String(goal.targetM), { place: goal.targetM, edge: goal.approachM });
    }
  }

  /** Whether a step has had no effect for longer than the person's patience. */
  private isRetryDue(timeS: number, { traits, latencyS }: Aim): boolean {
    if (this.goal?.kind !== "step" || this.isBusy) return false;
    return timeS > this.sinceS + traits.patienceS + latencyS;
  }

  private liftOff({ foot, place }: Step, timeS: number, aim: Aim, random: Random): void {
    const here = this.soles[foot] as Vector;
    const { goal } = this;
    const edges = this.edges.map((edge) => edge[1]);
    const lift = Math.max(LEAST_LIFT_M, goal?.approachM[1] ?? 0, ...edges);
    if (goal?.kind === "step" && this.queue.length === 0) {
      const approachM: Vector = goal.approachM[1] > LEAST_LIFT_M ? goal.approachM : [0, lift, 0];
      const into: ScriptedGoal = { ...goal, targetM: place, approachM };
      this.swing = { foot, path: aimedPath(aim, here, [0, lift, 0], into, timeS, random) };
      this.edges[foot] = approachM;
      return;
    }
    const over = [here, place].map(([x, y, z]): Vector => [x, y + lift, z]);
    const lastsS = aim.traits.tempo * (STEP_S + STEP_S_PER_M * onFloorM(here, place));
    this.swing = { foot, path: pathThrough([here, ...over, place], timeS, lastsS) };
    this.edges[foot] = this.boxes.get(String(place))?.edge ?? STILL;
  }
}

const footOf = (goal: ScriptedGoal): number => (goal.limb === "left" ? 0 : 1);

/** Steps until both feet are at their places; the foot with the longer way goes next. */
function stepsToStand(feet: Feet, places: Feet, strideM: number): Step[] {
  const now: [Vector, Vector] = [...feet];
  const steps: Step[] = [];
  while (steps.length <= MOST_STEPS) {
    const ways = [onFloorM(now[0], places[0]), onFloorM(now[1], places[1])] as const;
    const foot = ways[0] > ways[1] ? 0 : 1;
    if (ways[foot] < ARRIVED_M) return steps;
    now[foot] = towards(now[foot], places[foot], now[1 - foot] as Vector, strideM);
    steps.push({ foot, place: now[foot] });
  }
  throw tooFar(places[0]);
}

/** Steps of which the last one puts `foot` on the target; the other moves only as far as it must. */
function stepsOnto(
  feet: Feet,
  foot: number,
  target: Vector,
  strideM: number,
  spots: readonly Vector[],
): Step[] {
  const now: [Vector, Vector] = [...feet];
  const other = 1 - foot;
  const steps: Step[] = [];
  while (onFloorM(now[other] as Vector, target) > strideM) {
    const [mover, standing] = [now[other] as Vector, now[foot] as Vector];
    const near = placeNear(target, mover, standing, strideM, spots);
    now[other] = towards(mover, near, standing, strideM);
    steps.push({ foot: other, place: now[other] });
    if (onFloorM(now[other], target) > strideM) {
      now[foot] = towards(standing, near, now[other], strideM);
      steps.push({ foot, place: now[foot] });
    }
    if (steps.length > MOST_STEPS) throw tooFar(target);
  }
  return [...steps, { foot, place: target }];
}

/** Where a foot should stand for the other one to step on the target. */
function placeNear(
  target: Vector,
  mover: Vector,
  standing: Vector,
  strideM: number,
  spots: readonly Vector[],
): Vector {
  const gapM = FOLLOW_SHARE * strideM;
  const ahead = mover[2] - target[2];
  const isAmong = spots.some((spot) => onFloorM(mover, spot) < ARRIVED_M);
  if (Math.abs(ahead) <= gapM && !isAmong) {
    const aside = Math.sqrt(gapM * gapM - ahead * ahead);
    return [target[0] + (mover[0] > target[0] ? aside : -aside), 0, mover[2]];
  }
  const within = (a: Vector, b: Vector) => onFloorM(a, b) > 0 && onFloorM(a, b) <= strideM;
  const free = spots.filter((spot) => within(spot, target) && within(spot, standing));
  if (free.length > 0) {
    return free.reduce((best, one) => (onFloorM(one, mover) < onFloorM(best, mover) ? one : best));
  }
  const share = gapM / Math.max(onFloorM(target, mover), gapM);
  return [
    target[0] + share * (mover[0] - target[0]),
    0,
    target[2] + share * (mover[2] - target[2]),
  ];
}

/** The place, or the farthest point on the way to it within a stride of `standing`. */
function towards(foot: Vector, place: Vector, standing: Vector, strideM: number): Vector {
  for (const share of [1, 0.8, 0.65, 0.5, 0.35, 0.2, 0.1]) {
    const point: Vector = [
      foot[0] + share * (place[0] - foot[0]),
      place[1],
      foot[2] + share * (place[2] - foot[2]),
    ];
    if (onFloorM(point, standing) <= strideM) return share === 1 ? place : point;
  }
  return [foot[0] + 0.1 * (place[0] - foot[0]), place[1], foot[2] + 0.1 * (place[2] - foot[2])];
}

const tooFar = (target: Vector): RangeError =>
  new RangeError(`The place ${target.join(", ")} is more than ${MOST_STEPS} steps away.`);
