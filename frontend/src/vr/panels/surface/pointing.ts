/**
 * Pointing at a panel with rays, and pressing by trigger or pinch.
 *
 * A press counts when the selection begins while its ray is on a target. Tracked fingers tremble at
 * the moment of contact, so a selection that begins less than 150 ms after the previous one ended,
 * or after any press, is not taken as another; nor is one that was already held when its hand came
 * onto the target, or that begins before the new screen has been there for 150 ms.
 */
import { dot, minus, type Quaternion, rotate, type Vector } from "@shared/rotations";

export const DEBOUNCE_S = 0.15;

export interface Ray {
  readonly originM: Vector;
  readonly direction: Vector;
}

/** A flat rectangle in the room; its face looks along its own +z. */
export interface Board {
  readonly centreM: Vector;
  readonly rotation: Quaternion;
  readonly widthM: number;
  readonly heightM: number;
}

export interface Hit {
  /** From the upper left corner, as parts of the width and the height. */
  readonly across: number;
  readonly down: number;
  readonly distanceM: number;
}

/** Where a ray meets the front of a board; null if it misses it. */
export function hitOf({ originM, direction }: Ray, board: Board): Hit | null {
  const normal = rotate(board.rotation, [0, 0, 1]);
  const facing = dot(direction, normal);
  if (facing > -1e-6) return null;
  const distanceM = dot(minus(board.centreM, originM), normal) / facing;
  if (!(distanceM > 0)) return null;
  const at: Vector = [
    originM[0] + direction[0] * distanceM - board.centreM[0],
    originM[1] + direction[1] * distanceM - board.centreM[1],
    originM[2] + direction[2] * distanceM - board.centreM[2],
  ];
  const across = dot(at, rotate(board.rotation, [1, 0, 0])) / board.widthM + 0.5;
  const down = 0.5 - dot(at, rotate(board.rotation, [0, 1, 0])) / board.heightM;
  const isOn = across >= 0 && across <= 1 && down >= 0 && down <= 1;
  return isOn ? { across, down, distanceM } : null;
}

export type Side = "left" | "right";
export const SIDES: readonly Side[] = ["left", "right"];

/** What one hand does in a frame. */
export interface HandPointing {
  readonly hit: Hit | null;
  readonly target: string | null;
  readonly isSelecting: boolean;
}

export interface Pointed {
  /** The hand whose ray is shown on the panel; null if no ray meets it. */
  readonly side: Side | null;
  readonly target: string | null;
  /** The target that was pressed in this frame. */
  readonly pressed: string | null;
}

interface HandMemory {
  /** Null before its first frame. */
  isSelecting: boolean | null;
  releasedAtS: number;
}

const newHand = (): HandMemory => ({ isSelecting: null, releasedAtS: Number.NEGATIVE_INFINITY });

export class Pointer {
  readonly #hands: Record<Side, HandMemory> = { left: newHand(), right: newHand() };
  #side: Side = "right";
  #quietUntilS = Number.NEGATIVE_INFINITY;

  /** A new screen is shown: what was meant for the one before must not press on it. */
  screenChanged(nowS: number): void {
    this.#quietUntilS = Math.max(this.#quietUntilS, nowS + DEBOUNCE_S);
  }

  /** Both hands in one frame: who points at what, and whether something was pressed. */
  update(nowS: number, hands: Readonly<Record<Side, HandPointing>>): Pointed {
    let pressed: string | null = null;
    for (const side of SIDES) {
      if (!this.#begins(side, hands[side].isSelecting, nowS)) continue;
      const { target } = hands[side];
      if (hands[side].hit !== null) this.#side = side;
      if (pressed !== null || target === null || nowS < this.#quietUntilS) continue;
      pressed = target;
      this.#quietUntilS = nowS + DEBOUNCE_S;
    }
    const other: Side = this.#side === "left" ? "right" : "left";
    if (hands[this.#side].hit === null && hands[other].hit !== null) this.#side = other;
    const { hit, target } = hands[this.#side];
    return hit === null
      ? { side: null, target: null, pressed }
      : { side: this.#side, target, pressed };
  }

  /** Whether a selection begins, other than one that only trembles. */
  #begins(side: Side, isSelecting: boolean, nowS: number): boolean {
    const hand = this.#hands[side];
    const before = hand.isSelecting;
    hand.isSelecting = isSelecting;
    if (before === true && !isSelecting) hand.releasedAtS = nowS;
    return before === false && isSelecting && nowS - hand.releasedAtS >= DEBOUNCE_S;
  }
}
