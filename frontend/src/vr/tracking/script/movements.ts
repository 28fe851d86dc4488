/**
 * How a scripted person moves a hand or a foot: smooth paths through way-points, with the times and
 * the scatter of people. The server's `app/science/simulation` (`paths`, `aiming`, `traits`) does
 * the same and names what is published and what is assumed.
 *
 * A movement from a to b in the time d follows the minimum-jerk profile (Flash and Hogan 1985)
 * x(t) = a + (b - a) (10 s^3 - 15 s^4 + 6 s^5), s = t / d; several overlap a little and add up.
 * Movement times follow Fitts' law with lag (MacKenzie and Ware 1993); end points scatter by the
 * effective width (MacKenzie 1992).
 */
import { cross, dot, length, minus, plus, times, type Vector } from "@shared/rotations";
import type { Random } from "./random";

/** What a person wants to do next. */
export interface ScriptedGoal {
  readonly kind: "reach" | "step" | "walk_to";
  /** Which limb; null for walking. */
  readonly limb: "left" | "right" | null;
  readonly targetM: Vector;
  /** Half the width of what is aimed at. */
  readonly nearM: number;
  /** From the target out of its opening: the limb enters and leaves this way. */
  readonly approachM: Vector;
}

const OVERLAP = 0.25;
const FASTEST_MEAN_SPEED_M_S = 1.6;
const WAYPOINT_SCATTER = 1.5;
const NEARLY_THERE_M = 0.02;
const CARE = 0.5;
const FURTHER_M = 0.02;

/** The share of the way after a share of the time, both 0 to 1. */
export function minimumJerk(progress: number): number {
  const s = Math.min(Math.max(progress, 0), 1);
  return s * s * s * (10 + s * (6 * s - 15));
}

interface Move {
  readonly startS: number;
  readonly durationS: number;
  readonly wayM: Vector;
}

export class SmoothPath {
  constructor(
    readonly startM: Vector,
    readonly moves: readonly Move[],
  ) {}

  get endS(): number {
    return Math.max(...this.moves.map(({ startS, durationS }) => startS + durationS));
  }

  /** The same with movement `leg` and all later ones delayed until a time. */
  waitingToEnter(leg: number, untilS: number): SmoothPath {
    const delayS = Math.max(untilS - (this.moves[leg]?.startS ?? untilS), 0);
    return new SmoothPath(
      this.startM,
      this.moves.map((move, index) =>
        index < leg ? move : { ...move, startS: move.startS + delayS },
      ),
    );
  }

  /** The point at a time; constant before the start and after the end. */
  at(timeS: number): Vector {
    let point = this.startM;
    for (const { startS, durationS, wayM } of this.moves) {
      point = plus(point, times(wayM, minimumJerk((timeS - startS) / durationS)));
    }
    return point;
  }
}

/** A path through two or more points in `durationS`; all legs have equal acceleration. */
export function pathThrough(
  points: readonly Vector[],
  startS: number,
  durationS: number,
): SmoothPath {
  const legs = points.slice(1).map((point, index) => minus(point, points[index] as Vector));
  const shares = legs.map((leg) => Math.sqrt(length(leg)) + 1e-3);
  const sum = (values: readonly number[]) => values.reduce((total, one) => total + one, 0);
  // Every leg but the first starts before the previous one ends, which shortens the total time.
  const stretch = durationS / (sum(shares) - OVERLAP * sum(shares.slice(0, -1)));
  let begins = startS;
  const moves = legs.map((wayM, index) => {
    const lasts = (shares[index] as number) * stretch;
    const move = { startS: begins, durationS: lasts, wayM };
    begins += lasts * (1 - OVERLAP);
    return move;
  });
  return new SmoothPath(points[0] as Vector, moves);
}

/** One person's way of moving: times in seconds, factors, spreads of log times. */
export interface Traits {
  readonly reactionS: number;
  readonly tempo: number;
  readonly precision: number;
  readonly footTempo: number;
  readonly patienceS: number;
}

export function drawnTraits(random: Random): Traits {
  return {
    reactionS: Math.max(0.15, 0.27 + 0.05 * random.normal()),
    tempo: Math.exp(0.15 * random.normal()),
    precision: Math.exp(0.25 * random.normal()),
    footTempo: 1.4,
    patienceS: 1.2,
  };
}

export interface Aim {
  readonly traits: Traits;
  /** The delay that the person sees, which slows movements. */
  readonly latencyS: number;
  /** Factor on movement times, larger for a foot. */
  readonly tempo: number;
  /** How far beyond the surface a movement ends. */
  readonly pressM: number;
}

/**
 * A path that leaves by `wayOutM`, goes to the front of the goal, and enters it. After each miss the
 * person aims more carefully and reaches further in.
 */
export function aimedPath(
  { traits, latencyS, tempo, pressM }: Aim,
  hereM: Vector,
  wayOutM: Vector,
  goal: ScriptedGoal,
  startS: number,
  random: Random,
  misses = 0,
): SmoothPath {
  const care = CARE ** misses;
  const deepM = length(goal.approachM);
  let end = scattered(goal.targetM, goal, care * traits.precision, random);
  const points = [hereM];
  if (length(wayOutM) > NEARLY_THERE_M) points.push(plus(hereM, wayOutM));
  if (deepM > NEARLY_THERE_M) {
    const front = plus(goal.targetM, goal.approachM);
    points.push(scattered(front, goal, WAYPOINT_SCATTER * care * traits.precision, random));
    const press = pressM * (1 + 0.5 * Math.abs(random.normal())) + misses * FURTHER_M;
    end = minus(end, times(goal.approachM, press / deepM));
  }
  const stops = [...points, end];
  const wayM = stops
    .slice(1)
    .reduce((sum, stop, index) => sum + length(minus(stop, stops[index] as Vector)), 0);
  const difficulty = Math.log2(wayM / (2 * goal.nearM) + 1);
  const meanS = 0.23 + (0.169 + 1.03 * latencyS) * difficulty;
  const drawnS = traits.tempo * meanS * Math.exp(0.08 * random.normal());
  const lastsS = tempo * Math.max(drawnS, wayM / FASTEST_MEAN_SPEED_M_S);
  return pathThrough(stops, startS, lastsS);
}

/** Scatter a point across the approach, or in the floor's plane if there is none. */
function scattered(pointM: Vector, goal: ScriptedGoal, factor: number, random: Random): Vector {
  const sigma = (factor * 2 * goal.nearM) / 4.133;
  const drawn: Vector = [random.normal(), random.normal(), random.normal()];
  const axis: Vector = length(goal.approachM) > 1e-9 ? goal.approachM : [0, 1, 0];
  const across = minus(drawn, times(axis, dot(drawn, axis) / dot(axis, axis)));
  return plus(pointM, times(across, sigma));
}

/** A number that follows a goal smoothly: a critically damped spring, solved exactly. */
export class Follower {
  private speed = 0;

  constructor(
    public value: number,
    private readonly rate: number,
  ) {}

  follow(goal: number, stepS: number): number {
    const away = this.value - goal;
    const push = this.speed + this.rate * away;
    const fade = Math.exp(-this.rate * stepS);
    this.value = goal + (away + push * stepS) * fade;
    this.speed = (this.speed - this.rate * push * stepS) * fade;
    return this.value;
  }
}

/** The unit vector along v, or another one if v has no direction. */
export function unit(v: Vector, otherwise: Vector): Vector {
  const size = length(v);
  return size > 1e-9 ? times(v, 1 / size) : otherwise;
}

/** The part of `v` across a unit vector, of length 1; of a spare vector if `v` lies along it. */
export function across(along: Vector, v: Vector): Vector {
  for (const candidate of [v, [0, 0, -1], [0, -1, 0]] as readonly Vector[]) {
    const rest = minus(candidate, times(along, dot(along, candidate)));
    if (length(rest) > 1e-3 * length(candidate)) return times(rest, 1 / length(rest));
  }
  return cross(along, [1, 0, 0]);
}
