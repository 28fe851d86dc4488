/** What is drawn on a stage, and how it is distinguished. */

import type { Seconds } from "../units";
import type { BodyMarks } from "./marks";
import type { PointMotion } from "./motion";
import type { Worn } from "./skin/worn";

/** Which points of a skeleton are which part of a body; unknown ones are left out. */
export interface BodyRoles {
  readonly head: number | null;
  readonly leftHip: number | null;
  readonly rightHip: number | null;
  readonly left: ReadonlySet<number>;
  readonly right: ReadonlySet<number>;
}

export interface Figure {
  readonly key: string;
  readonly motion: PointMotion;
  /** A ghost is there for comparison: grey and translucent. */
  readonly tone: "solid" | "ghost";
  /** Offset on the floor, metres. */
  readonly offset?: readonly [x: number, z: number];
  readonly roles?: BodyRoles;
  /**
   * The movement, in the joints of the body, of the one who sees through this figure's eyes; if it
   * is left out or has no rotations, the eyes look where the figure faces.
   */
  readonly seenBy?: PointMotion;
  /** The point to highlight. */
  readonly highlighted?: number | null;
  /** The body to draw it with; without one it is drawn as a skeleton. */
  readonly worn?: Worn;
  /** Words above the figure's head, and their height above the floor in metres. */
  readonly label?: { readonly text: string; readonly heightM: number };
  /** Parts that are marked at a time, because their settings were changed. */
  readonly marks?: (time: Seconds) => BodyMarks;
}

/**
 * The camera: `orbit` stays where it is, `follow` moves along, `eyes` looks through the first
 * figure's.
 */
export type CameraMode = "orbit" | "follow" | "eyes";
export type CameraSide = "corner" | "front" | "side" | "back" | "top";

export interface StagePalette {
  readonly ground: string;
  readonly line: string;
  readonly lineStrong: string;
  readonly ink: string;
  readonly trunk: string;
  readonly left: string;
  readonly right: string;
  readonly ghost: string;
  readonly unseen: string;
  readonly highlight: string;
  readonly shadow: string;
  readonly font: string;
}

/** Distinguishable with any kind of colour vision; the same in both colour schemes. */
export const LEFT_COLOUR = "#8067c9";
export const RIGHT_COLOUR = "#d55e00";

export function paletteOf(element: HTMLElement): StagePalette {
  const style = getComputedStyle(element);
  const token = (name: string, fallback: string) => style.getPropertyValue(name).trim() || fallback;
  return {
    ground: token("--sunken", "#edf1f1"),
    line: token("--line", "#dbe2e2"),
    lineStrong: token("--line-strong", "#8a9898"),
    ink: token("--ink", "#1a2424"),
    trunk: token("--accent", "#0e6873"),
    left: LEFT_COLOUR,
    right: RIGHT_COLOUR,
    ghost: token("--stage-ghost", "#52605f"),
    unseen: token("--warn", "#8a5200"),
    highlight: token("--warn-line", "#d69a3c"),
    shadow: token("--stage-shadow", "#cbd4d4"),
    font: style.fontFamily,
  };
}

/** The point that a camera follows: the middle of the hips if known, otherwise of all points. */
export function middleOf(
  figure: Figure,
  placed: Float32Array,
): readonly [x: number, y: number, z: number] {
  const { leftHip = null, rightHip = null } = figure.roles ?? {};
  const chosen =
    leftHip !== null && rightHip !== null
      ? [leftHip, rightHip]
      : figure.motion.names.map((_, point) => point);
  const sum = [0, 0, 0];
  let count = 0;
  for (const point of chosen) {
    if (Number.isNaN(placed[3 * point] ?? Number.NaN)) continue;
    count++;
    for (let axis = 0; axis < 3; axis++) {
      sum[axis] = (sum[axis] ?? 0) + (placed[3 * point + axis] ?? 0);
    }
  }
  const [x = 0, y = 0, z = 0] = sum.map((value) => value / Math.max(1, count));
  return [x, y, z];
}

/**
 * The direction a body faces on the floor, from its hips: up x (left to right). Null if unknown.
 */
export function facingOf(
  figure: Figure,
  placed: Float32Array,
): readonly [x: number, z: number] | null {
  const { leftHip = null, rightHip = null } = figure.roles ?? {};
  if (leftHip === null || rightHip === null) return null;
  const x = (placed[3 * rightHip] ?? 0) - (placed[3 * leftHip] ?? 0);
  const z = (placed[3 * rightHip + 2] ?? 0) - (placed[3 * leftHip + 2] ?? 0);
  const length = Math.hypot(x, z);
  // y x (x, 0, z) = (z, 0, -x)
  return length > 1e-6 ? [z / length, -x / length] : null;
}

// Blocks in the scene: walls and panels of boxes, targets, starting places.

/** How a block looks: `plain` by default; the other tones have a meaning and glow. */
export type BlockTone = "plain" | "good" | "touched" | "odd" | "bad";

export interface Block {
  readonly key: string;
  /** Walls are see-through; other blocks are there to be touched. */
  readonly wall: boolean;
  /** Metres, in the world of the figures. */
  readonly center: readonly [x: number, y: number, z: number];
  readonly halfSize: readonly [x: number, y: number, z: number];
}

/** The tones of the blocks that are not `plain`, by their keys. */
export type BlockTones = ReadonlyMap<string, BlockTone>;

/** Distinguishable with any kind of colour vision, and also by the strength of their lines. */
export const BLOCK_COLOURS: Readonly<Record<Exclude<BlockTone, "plain">, string>> = {
  good: "#009e73",
  touched: "#3a8fd6",
  odd: "#e0a100",
  bad: "#d43d1a",
};
