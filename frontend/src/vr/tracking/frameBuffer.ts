/** One frame of tracking that sources fill again and again. */
import type { Place } from "@shared/avatar/hips";
import type { Vector } from "@shared/rotations";
import type {
  GoalPart,
  GoalState,
  HandInput,
  TrackedFrame,
  TrackedPart,
  TrackingDevice,
} from "./tracked";

export type HandSide = "left" | "right";
export const HAND_SIDES = ["left", "right"] as const;

/** The finger parts of one hand, four values each. */
export const FINGER_VALUES = 60;

type Mutable<T> = { -readonly [Key in keyof T]: T[Key] };
export type MutablePart = Mutable<TrackedPart>;
export type MutableHand = Mutable<HandInput>;

export interface FrameBuffer extends TrackedFrame {
  timeS: number;
  eyes: Place | null;
  readonly parts: Record<GoalPart, MutablePart>;
  readonly hands: Record<HandSide, MutableHand>;
}

const lost = (): MutablePart => ({ place: null, state: "lost", device: null });

const emptyHand = (): MutableHand => ({
  fingers: null,
  ray: null,
  isSelecting: false,
  isSqueezing: false,
  holdsController: false,
});

export const frameBuffer = (): FrameBuffer => ({
  timeS: 0,
  eyes: null,
  parts: {
    Hips: lost(),
    Head: lost(),
    LeftHand: lost(),
    RightHand: lost(),
    LeftLowerLeg: lost(),
    RightLowerLeg: lost(),
  },
  hands: { left: emptyHand(), right: emptyHand() },
});

/** Forget what the last frame held. */
export function clear(buffer: FrameBuffer, timeS: number): void {
  buffer.timeS = timeS;
  buffer.eyes = null;
  for (const part of Object.values(buffer.parts)) lose(part);
  for (const hand of Object.values(buffer.hands)) Object.assign(hand, NOTHING);
}

const NOTHING: HandInput = emptyHand();

export function set(
  part: MutablePart,
  place: Place,
  device: TrackingDevice,
  state: GoalState = "tracked",
): void {
  part.place = place;
  part.state = state;
  part.device = device;
}

export function lose(part: MutablePart): void {
  part.place = null;
  part.state = "lost";
  part.device = null;
}

/** Without a tracker at the waist, inverse kinematics infers the hips from head and shins. */
export function inferHips({ parts, eyes }: FrameBuffer): void {
  if (parts.Hips.place !== null) return;
  const { LeftLowerLeg: left, RightLowerLeg: right } = parts;
  const canInfer = eyes !== null && left.place !== null && right.place !== null;
  parts.Hips.state = canInfer ? "inferred" : "lost";
}

export type Ray = { readonly originM: Vector; readonly direction: Vector };
