import type { Quaternion } from "@shared/rotations";
import { describe, expect, it } from "vitest";
import { rayTo } from "../testing/pointing";
import { type Board, type HandPointing, hitOf, Pointer } from "./pointing";

const BOARD: Board = { centreM: [0, 1.5, -2], rotation: [1, 0, 0, 0], widthM: 2, heightM: 1 };

describe("a ray and a board", () => {
  it("meet where the ray crosses it, in parts from the upper left corner", () => {
    expect(hitOf(rayTo([0.3, 1, 0], [0.5, 1.75, -2]), BOARD)).toEqual({
      across: expect.closeTo(0.75, 9),
      down: expect.closeTo(0.25, 9),
      distanceM: expect.closeTo(Math.hypot(0.2, 0.75, 2), 9),
    });
  });

  it("meet on a board that is turned and tilted", () => {
    const half = Math.PI / 8;
    const rotation: Quaternion = [Math.cos(half), 0, Math.sin(half), 0];
    const board = { ...BOARD, centreM: [-1, 1.5, -1] as const, rotation };
    // Half a metre along the board's own x, which points to (cos 45, 0, -sin 45).
    const at = [-1 + 0.5 * Math.SQRT1_2, 1.5, -1 - 0.5 * Math.SQRT1_2] as const;
    expect(hitOf(rayTo([0, 1.2, 0], at), board)?.across).toBeCloseTo(0.75, 9);
  });

  it("do not meet beside the board, behind the hand, or from its back", () => {
    expect(hitOf(rayTo([0, 1.5, 0], [1.1, 1.5, -2]), BOARD)).toBeNull();
    expect(hitOf(rayTo([0, 1.5, 0], [0, 1.5, 2]), BOARD)).toBeNull();
    expect(hitOf(rayTo([0, 1.5, -4], [0, 1.5, -2]), BOARD)).toBeNull();
    expect(hitOf(rayTo([0, 1.5, 0], [0, 1.5, 1e9]), BOARD)).toBeNull();
  });
});

const HIT = { across: 0.5, down: 0.5, distanceM: 2 };
const idle: HandPointing = { hit: null, target: null, isSelecting: false };
const on = (target: string | null, isSelecting = false): HandPointing => ({
  hit: HIT,
  target,
  isSelecting,
});

/** What is pressed when the right hand does this, frame by frame at 90 Hz. */
function pressed(pointer: Pointer, hands: readonly HandPointing[], startS = 10): string[] {
  return hands.flatMap((right, frame) => {
    const { pressed: one } = pointer.update(startS + frame / 90, { left: idle, right });
    return one ?? [];
  });
}

const frames = (count: number, hand: HandPointing): HandPointing[] => Array(count).fill(hand);

describe("a press", () => {
  it("is one selection that begins on a target, however long it is held", () => {
    const hands = [...frames(5, on("a")), ...frames(200, on("a", true)), ...frames(5, on("a"))];
    expect(pressed(new Pointer(), hands)).toEqual(["a"]);
  });

  it("is one press if the pinch trembles for less than 150 ms", () => {
    const tremble = [2, 3, 13].flatMap((count) => [
      ...frames(count, on("a")),
      ...frames(4, on("a", true)),
    ]);
    expect(pressed(new Pointer(), [on("a"), on("a", true), ...tremble])).toEqual(["a"]);
  });

  it("counts again after 150 ms", () => {
    const again = [on("a", true), ...frames(15, on("a")), on("a", true)];
    expect(pressed(new Pointer(), [on("a"), ...again])).toEqual(["a", "a"]);
  });

  it("is none if the selection began elsewhere, or before the hand was seen", () => {
    const dragged = [on(null), on(null, true), ...frames(9, on("a", true))];
    expect(pressed(new Pointer(), dragged)).toEqual([]);
    expect(pressed(new Pointer(), frames(9, on("a", true)))).toEqual([]);
  });

  it("is none for 150 ms after another screen was shown", () => {
    const pointer = new Pointer();
    pressed(pointer, frames(9, on("a")), 5);
    pointer.screenChanged(10);
    expect(pressed(pointer, [...frames(13, on("a")), on("a", true)], 10)).toEqual([]);
    expect(pressed(pointer, [...frames(14, on("a")), on("a", true)], 11)).toEqual(["a"]);
  });

  it("of both hands at once is one", () => {
    const pointer = new Pointer();
    pointer.update(1, { left: on("a"), right: on("b") });
    const both = pointer.update(1.01, { left: on("a", true), right: on("b", true) });
    expect(both.pressed).toBe("a");
    expect(pointer.update(1.02, { left: on("a", true), right: on("b", true) }).pressed).toBeNull();
  });
});

describe("the hand that points", () => {
  it("is the one that pressed last, and the other one if only that is on the panel", () => {
    const pointer = new Pointer();
    expect(pointer.update(1, { left: on("a"), right: on("b") }).side).toBe("right");
    pointer.update(1.1, { left: on("a", true), right: on("b") });
    expect(pointer.update(1.2, { left: on("a"), right: on("b") })).toMatchObject({
      side: "left",
      target: "a",
    });
    expect(pointer.update(1.3, { left: idle, right: on("b") }).side).toBe("right");
    expect(pointer.update(1.4, { left: idle, right: idle })).toMatchObject({
      side: null,
      target: null,
    });
  });
});
