/**
 * What mouse and keyboard ask of a participant on the desktop, apart from any page: keys and mouse
 * go in, and the body that stands in for the participant is told what to do.
 *
 * The mouse looks around. While its right button is held, a hand reaches where the eyes look, as far
 * away as the wheel says; its left button selects. Feet step with keys, onto what is looked at or
 * around.
 */
import { plus, rotate, times, type Vector } from "@shared/rotations";
import { turned } from "../places";
import type { PersonSide, ScriptedGoal, ScriptedPerson } from "../script";

/** What a key does; `DESKTOP_KEYS` says which key. */
export const DESKTOP_ACTIONS = [
  "forwards",
  "backwards",
  "leftwards",
  "rightwards",
  "left_foot",
  "right_foot",
  "other_hand",
  "grips",
  "squat",
  "t_pose",
  "help",
] as const;
export type DesktopAction = (typeof DESKTOP_ACTIONS)[number];

/** By `KeyboardEvent.code`, so that they lie the same on every keyboard. */
export const DESKTOP_KEYS: Readonly<Record<string, DesktopAction>> = {
  KeyW: "forwards",
  KeyS: "backwards",
  KeyA: "leftwards",
  KeyD: "rightwards",
  KeyQ: "left_foot",
  KeyE: "right_foot",
  KeyX: "other_hand",
  Space: "grips",
  KeyC: "squat",
  KeyT: "t_pose",
  KeyH: "help",
};

const RAD_PER_PIXEL = 0.0022;
const MOST_PITCH_RAD = 1.35;
const MOST_YAW_RAD = 1.2;
const NEAREST_M = 0.25;
const FARTHEST_M = 0.75;
const DEPTH_PER_NOTCH_M = 0.0006;
/** A single step, and each further one while the key is held: 0.5 m/s. */
const STEP_M = 0.3;
const STRIDE_M = 0.65;
const LIFT_M = 0.3;
const MOST_STEP_M = 1.2;
const FORWARDS: Vector = [0, 0, -1];
const AROUND: Readonly<Partial<Record<DesktopAction, readonly [x: number, z: number]>>> = {
  forwards: [0, -1],
  backwards: [0, 1],
  leftwards: [-1, 0],
  rightwards: [1, 0],
};

/**
 * What is held down, as frames see it: what was pressed and let go between two frames is held for one
 * frame, however far apart frames are.
 */
class Held<What> {
  private readonly held = new Set<What>();
  /** Pressed since the last frame, which has not seen it. */
  private readonly unseen = new Set<What>();
  /** Let go before a frame has seen it. */
  private readonly brief = new Set<What>();

  press(what: What): void {
    this.held.add(what);
    this.unseen.add(what);
    this.brief.delete(what);
  }

  release(what: What): void {
    if (this.unseen.has(what)) this.brief.add(what);
    else this.held.delete(what);
  }

  releaseAll(): void {
    for (const what of [...this.held]) this.release(what);
  }

  has(what: What): boolean {
    return this.held.has(what);
  }

  /** A frame has seen everything that is held. */
  seen(): void {
    for (const what of this.brief) this.held.delete(what);
    this.unseen.clear();
    this.brief.clear();
  }

  [Symbol.iterator](): IterableIterator<What> {
    return this.held.values();
  }
}

export class DesktopControls {
  /** The hand that reaches. */
  side: PersonSide = "right";
  yawRad = 0;
  pitchRad = -0.15;
  depthM = 0.6;
  isReaching = false;
  private readonly held = new Held<DesktopAction | "select">();
  private steps: readonly (0 | 1)[] = [];
  private isWalking = false;

  /** The mouse moved by pixels. */
  look(rightwards: number, downwards: number): void {
    const clamp = (value: number, most: number) => Math.min(most, Math.max(-most, value));
    this.yawRad = clamp(this.yawRad - RAD_PER_PIXEL * rightwards, MOST_YAW_RAD);
    this.pitchRad = clamp(this.pitchRad - RAD_PER_PIXEL * downwards, MOST_PITCH_RAD);
  }

  /** The wheel turned; away from the person is farther. */
  wheel(downwards: number): void {
    const depthM = this.depthM - DEPTH_PER_NOTCH_M * downwards;
    this.depthM = Math.min(FARTHEST_M, Math.max(NEAREST_M, depthM));
  }

  /** A key was pressed; false if it means nothing here. */
  press(action: DesktopAction): void {
    if (action === "other_hand") this.side = this.side === "right" ? "left" : "right";
    if (action === "left_foot") this.steps = [...this.steps.slice(-1), 0];
    if (action === "right_foot") this.steps = [...this.steps.slice(-1), 1];
    this.held.press(action);
  }

  release(action: DesktopAction): void {
    this.held.release(action);
  }

  /** The button that selects went down or up. */
  select(isDown: boolean): void {
    if (isDown) this.held.press("select");
    else this.held.release("select");
  }

  /** The page lost the keyboard: nothing is held any more. */
  releaseAll(): void {
    this.held.releaseAll();
    this.isReaching = false;
  }

  get isGripping(): boolean {
    return this.held.has("grips");
  }

  /** The direction of the eyes in the world. */
  get gaze(): Vector {
    const [yaw, pitch] = [turned([0, 1, 0], this.yawRad), turned([1, 0, 0], this.pitchRad)];
    return rotate(yaw, rotate(pitch, FORWARDS));
  }

  /** Tell the body what is asked for now; `eyesM`: where its eyes are. */
  direct(person: ScriptedPerson, eyesM: Vector): void {
    const { gaze } = this;
    const isSelecting = this.held.has("select");
    person.lookAt(plus(eyesM, times(gaze, 2)));
    for (const side of ["left", "right"] as const) {
      const isOwn = side === this.side;
      const tipM = isOwn && this.isReaching ? plus(eyesM, times(gaze, this.depthM)) : null;
      person.guide(side, tipM, gaze);
      person.selects[side] = isOwn && isSelecting;
      person.squeezes[side] = this.isGripping;
    }
    person.squat = this.held.has("squat") ? 1 : 0;
    person.take(this.held.has("t_pose") ? "t_pose" : "ease");
    if (!person.isStepping) this.walk(person, eyesM);
    this.held.seen();
  }

  private walk(person: ScriptedPerson, eyesM: Vector): void {
    const [foot, ...later] = this.steps;
    if (foot !== undefined) {
      this.steps = later;
      const targetM = this.floorLookedAt(person, eyesM);
      const limb = foot === 0 ? "left" : "right";
      if (targetM !== null) person.pursue(goal("step", limb, targetM));
      return;
    }
    let [wayX, wayZ] = [0, 0];
    for (const action of this.held) {
      const [x, z] = (action === "select" ? undefined : AROUND[action]) ?? [0, 0];
      wayX += x;
      wayZ += z;
    }
    const [x, z] = person.standsAt;
    const lengthM = this.isWalking ? STRIDE_M : STEP_M;
    this.isWalking = wayX !== 0 || wayZ !== 0;
    if (!this.isWalking) return;
    person.pursue(goal("walk_to", null, [x + wayX * lengthM, 0, z + wayZ * lengthM]));
  }

  /** The place on the floor that is looked at, if a step leads there. */
  private floorLookedAt(person: ScriptedPerson, eyesM: Vector): Vector | null {
    const { gaze } = this;
    if (gaze[1] > -0.05) return null;
    const at = plus(eyesM, times(gaze, -eyesM[1] / gaze[1]));
    const [x, z] = person.standsAt;
    return Math.hypot(at[0] - x, at[2] - z) > MOST_STEP_M ? null : [at[0], 0, at[2]];
  }
}

const goal = (
  kind: "step" | "walk_to",
  limb: PersonSide | null,
  targetM: Vector,
): ScriptedGoal => ({ kind, limb, targetM, nearM: 0.05, approachM: [0, LIFT_M, 0] });
