/**
 * How a frame's input and result lie in memory that the page and the worker share, or that they send
 * to and fro. All numbers are doubles but the touches, which are bytes.
 */
import { FINGER_PARTS, JOINTS } from "@shared/avatar/anatomy.generated";
import { GOAL_PARTS, type Goals } from "@shared/avatar/goals";
import type { Place } from "@shared/avatar/hips";
import type { Health } from "@shared/avatar/physics/simulation";

const POSE = 3 + 4 * JOINTS.length;
const FINGERS = 4 * FINGER_PARTS.length;
const PLACE = 8;

/** Inputs: time, whether fingers are given, six goals (known, position, rotation), fingers. */
const TIME = 0;
const HAS_FINGERS = 1;
const GOALS = 2;
const GIVEN_FINGERS = GOALS + PLACE * GOAL_PARTS.length;
export const INPUT_VALUES = GIVEN_FINGERS + FINGERS;

/** Results. */
const TOOK_MS = 1;
const IK_MS = 2;
const SKIPPED_GAPS = 3;
/** Which `showSurfaces` the touches belong to, and how many bytes they are. */
const SHOWN = 4;
const TOUCHES = 5;
const RESULT_HAS_FINGERS = 6;
const HEALTH = 7;
const HEALTH_NAMES = [
  "restored",
  "resets",
  "ignoredInputs",
  "limitedTargets",
  "teleports",
] as const;
const GOAL_ERRORS = HEALTH + HEALTH_NAMES.length;
const LOCAL = GOAL_ERRORS + GOAL_PARTS.length;
const REMOTE = LOCAL + POSE;
const LOCAL_FINGERS = REMOTE + POSE;
const REMOTE_FINGERS = LOCAL_FINGERS + FINGERS;
const RESULT_VALUES = REMOTE_FINGERS + FINGERS;
/** Room for the touches of the largest task, 16 boxes of 6 sides, target and start, by 52 parts. */
const MOST_TOUCHES = 128 * (JOINTS.length + FINGER_PARTS.length);
export const INPUT_BYTES = 8 * INPUT_VALUES;
export const RESULT_BYTES = 8 * RESULT_VALUES + 2 * MOST_TOUCHES;

/** One input, in a piece of memory. */
export class InputSlot {
  readonly goals: Goals;
  private readonly values: Float64Array;
  private readonly places: readonly MutablePlace[];
  private readonly ownFingers: Float64Array;

  constructor(buffer: ArrayBufferLike, at = 0) {
    this.values = new Float64Array(buffer, at, INPUT_VALUES);
    this.ownFingers = this.values.subarray(GIVEN_FINGERS);
    this.places = GOAL_PARTS.map(() => ({ positionM: [0, 0, 0], rotation: [1, 0, 0, 0] }));
    this.goals = Object.fromEntries(GOAL_PARTS.map((part) => [part, null])) as unknown as Goals;
  }

  /** Its memory, if it is its own. */
  get buffer(): ArrayBuffer {
    return this.values.buffer as ArrayBuffer;
  }

  get timeS(): number {
    return this.values[TIME] as number;
  }

  get fingers(): Float64Array | null {
    return this.values[HAS_FINGERS] === 1 ? this.ownFingers : null;
  }

  write(timeS: number, goals: Goals, fingers: Float64Array | null): void {
    const { values } = this;
    values[TIME] = timeS;
    values[HAS_FINGERS] = fingers === null ? 0 : 1;
    if (fingers !== null) this.ownFingers.set(fingers);
    for (let row = 0; row < GOAL_PARTS.length; row++) {
      const goal = goals[GOAL_PARTS[row] as keyof Goals];
      const at = GOALS + PLACE * row;
      values[at] = goal === null ? 0 : 1;
      if (goal === null) continue;
      for (let i = 0; i < 3; i++) values[at + 1 + i] = goal.positionM[i] as number;
      for (let i = 0; i < 4; i++) values[at + 4 + i] = goal.rotation[i] as number;
    }
  }

  /** Read the goals into `goals`, which is the same object every time. */
  readGoals(): Goals {
    const { values, places } = this;
    const goals = this.goals as Record<keyof Goals, Place | null>;
    for (let row = 0; row < GOAL_PARTS.length; row++) {
      const part = GOAL_PARTS[row] as keyof Goals;
      const at = GOALS + PLACE * row;
      if (values[at] === 0) {
        goals[part] = null;
        continue;
      }
      const place = places[row] as MutablePlace;
      for (let i = 0; i < 3; i++) place.positionM[i] = values[at + 1 + i] as number;
      for (let i = 0; i < 4; i++) place.rotation[i] = values[at + 4 + i] as number;
      goals[part] = place;
    }
    return goals;
  }
}

interface MutablePlace {
  readonly positionM: [number, number, number];
  readonly rotation: [number, number, number, number];
}

/** What a result is written from. */
export interface Computed {
  readonly timeS: number;
  readonly tookMs: number;
  readonly ikMs: number;
  readonly skippedGaps: number;
  /** The number of the last `showSurfaces`. */
  readonly shown: number;
  readonly local: Float64Array;
  readonly remote: Float64Array;
  readonly localFingers: Float64Array | null;
  readonly remoteFingers: Float64Array | null;
  readonly goalErrorsM: Float64Array;
  readonly touched: Uint8Array;
  readonly near: Uint8Array;
  readonly health: Health;
}

/** One result, in a piece of memory. */
export class ResultSlot {
  private readonly values: Float64Array;
  private readonly touched: Uint8Array;
  private readonly near: Uint8Array;

  constructor(buffer: ArrayBufferLike, at = 0) {
    this.values = new Float64Array(buffer, at, RESULT_VALUES);
    const bytes = at + 8 * RESULT_VALUES;
    this.touched = new Uint8Array(buffer, bytes, MOST_TOUCHES);
    this.near = new Uint8Array(buffer, bytes + MOST_TOUCHES, MOST_TOUCHES);
  }

  get timeS(): number {
    return this.values[TIME] as number;
  }

  get tookMs(): number {
    return this.values[TOOK_MS] as number;
  }

  get ikMs(): number {
    return this.values[IK_MS] as number;
  }

  get skippedGaps(): number {
    return this.values[SKIPPED_GAPS] as number;
  }

  get shown(): number {
    return this.values[SHOWN] as number;
  }

  get touchBytes(): number {
    return this.values[TOUCHES] as number;
  }

  get hasFingers(): boolean {
    return this.values[RESULT_HAS_FINGERS] === 1;
  }

  write(one: Computed): void {
    const { values } = this;
    if (one.touched.length > MOST_TOUCHES) {
      throw new Error(`${one.touched.length} pairs of surface and part are too many.`);
    }
    values[TIME] = one.timeS;
    values[TOOK_MS] = one.tookMs;
    values[IK_MS] = one.ikMs;
    values[SKIPPED_GAPS] = one.skippedGaps;
    values[SHOWN] = one.shown;
    values[TOUCHES] = one.touched.length;
    for (let i = 0; i < HEALTH_NAMES.length; i++) {
      values[HEALTH + i] = one.health[HEALTH_NAMES[i] as keyof Health];
    }
    values.set(one.goalErrorsM, GOAL_ERRORS);
    values.set(one.local, LOCAL);
    values.set(one.remote, REMOTE);
    const hasFingers = one.localFingers !== null && one.remoteFingers !== null;
    values[RESULT_HAS_FINGERS] = hasFingers ? 1 : 0;
    if (hasFingers) {
      values.set(one.localFingers as Float64Array, LOCAL_FINGERS);
      values.set(one.remoteFingers as Float64Array, REMOTE_FINGERS);
    }
    this.touched.set(one.touched);
    this.near.set(one.near);
  }

  readPoses(local: Float64Array, remote: Float64Array, goalErrorsM: Float64Array): void {
    copy(this.values, LOCAL, local);
    copy(this.values, REMOTE, remote);
    copy(this.values, GOAL_ERRORS, goalErrorsM);
  }

  readFingers(local: Float64Array, remote: Float64Array): void {
    copy(this.values, LOCAL_FINGERS, local);
    copy(this.values, REMOTE_FINGERS, remote);
  }

  readTouches(touched: Uint8Array, near: Uint8Array): void {
    copy(this.touched, 0, touched);
    copy(this.near, 0, near);
  }

  readHealth(into: { -readonly [Name in keyof Health]: number }): void {
    for (let i = 0; i < HEALTH_NAMES.length; i++) {
      into[HEALTH_NAMES[i] as keyof Health] = this.values[HEALTH + i] as number;
    }
  }
}

function copy<Values extends Float64Array | Uint8Array>(
  from: Values,
  at: number,
  into: Values,
): void {
  for (let i = 0; i < into.length; i++) into[i] = from[at + i] as number;
}
