import { dot, length, minus, type Vector } from "@shared/rotations";
import { describe, expect, it } from "vitest";
import type { TrackedFrame } from "../tracked";
import { DESKTOP_ACTIONS, DESKTOP_KEYS } from "./controls";
import { DesktopSource } from "./source";

const RATE_HZ = 90;

class Desk {
  readonly source = new DesktopSource(1.7);
  private timeS = 0;

  frames(seconds: number, look?: (frame: TrackedFrame) => void): TrackedFrame {
    let last = this.source.read(this.timeS);
    for (let frame = 0; frame < seconds * RATE_HZ; frame++) {
      this.timeS += 1 / RATE_HZ;
      last = this.source.read(this.timeS);
      look?.(last);
    }
    return last;
  }
}

const at = (frame: TrackedFrame, part: keyof TrackedFrame["parts"]): Vector =>
  frame.parts[part].place?.positionM as Vector;

describe("A participant at a desk", () => {
  it("gives every action one key", () => {
    expect(Object.values(DESKTOP_KEYS).toSorted()).toEqual([...DESKTOP_ACTIONS].toSorted());
  });

  it("looks where the mouse goes at once: left and up", () => {
    const desk = new Desk();
    const before = desk.frames(0.1).eyes?.positionM;
    desk.source.controls.look(-200, -100);
    const { eyes } = desk.frames(1 / RATE_HZ);
    const [x, y, z] = desk.source.controls.gaze;
    expect([x < -0.3, y > 0, z < -0.5]).toEqual([true, true, true]);
    expect(length(minus(eyes?.positionM as Vector, before as Vector))).toBeLessThan(0.01);
    desk.source.controls.look(-1e6, 1e6);
    expect(Math.abs(desk.source.controls.yawRad)).toBeLessThan(Math.PI / 2);
  });

  it("reaches with a finger to where the eyes look, as far as the wheel says", () => {
    const desk = new Desk();
    const { controls } = desk.source;
    controls.isReaching = true;
    for (const [downwards, farther] of [
      [0, false],
      [-80, true],
    ] as const) {
      controls.wheel(downwards);
      const frame = desk.frames(1.5);
      const hand = at(frame, "RightHand");
      const way = minus(hand, frame.eyes?.positionM as Vector);
      const along = dot(way, controls.gaze);
      expect(Math.abs(along - (controls.depthM - 0.108 * 1.7))).toBeLessThan(0.07);
      expect(Math.sqrt(Math.max(0, dot(way, way) - along * along))).toBeLessThan(0.07);
      expect(controls.depthM > 0.62).toBe(farther);
    }
    controls.isReaching = false;
    expect(at(desk.frames(1), "RightHand")[1]).toBeLessThan(1.05);
  });

  it("walks while a key is held, steps onto what it looks at, and stays when all is let go", () => {
    const desk = new Desk();
    const { controls } = desk.source;
    desk.frames(0.2);
    controls.press("forwards");
    desk.frames(3);
    controls.releaseAll();
    const stood = at(desk.frames(2), "Head");
    expect(stood[2]).toBeLessThan(-0.4);
    controls.look(0, 470);
    controls.press("left_foot");
    controls.release("left_foot");
    let highest = 0;
    const stepped = desk.frames(3, (frame) => {
      highest = Math.max(highest, at(frame, "LeftLowerLeg")[1]);
    });
    expect(highest).toBeGreaterThan(0.55);
    expect(at(stepped, "LeftLowerLeg")[2]).toBeLessThan(at(stepped, "RightLowerLeg")[2] - 0.1);
    const end = at(desk.frames(1), "LeftLowerLeg");
    expect(length(minus(end, at(stepped, "LeftLowerLeg")))).toBeLessThan(0.02);
  });

  it("takes a short step for a short press, and longer ones while the key is held", () => {
    const pressed = (seconds: number) => {
      const desk = new Desk();
      desk.frames(0.2);
      const beganM = at(desk.frames(0.1), "Head")[2];
      desk.source.controls.press("forwards");
      desk.frames(seconds);
      desk.source.controls.releaseAll();
      return beganM - at(desk.frames(2), "Head")[2];
    };
    expect(Math.abs(pressed(1 / RATE_HZ) - 0.3)).toBeLessThan(0.05);
    // Over a road of 5 m and to the start square's place behind it.
    expect(pressed(15)).toBeGreaterThan(6.6);
  });

  it("presses both grips, and selects with the hand that it uses", () => {
    const desk = new Desk();
    const { controls } = desk.source;
    controls.press("grips");
    controls.press("other_hand");
    controls.select(true);
    const { hands, parts } = desk.frames(0.1);
    expect([hands.left.isSqueezing, hands.right.isSqueezing]).toEqual([true, true]);
    expect([hands.left.isSelecting, hands.right.isSelecting]).toEqual([true, false]);
    expect([hands.left.ray === null, hands.right.ray === null]).toEqual([false, true]);
    expect(parts.LeftLowerLeg).toMatchObject({ state: "tracked", device: "joint" });
  });

  it("holds for one frame what was pressed and let go between two frames", () => {
    const desk = new Desk();
    const { controls } = desk.source;
    desk.frames(0.1);
    controls.press("grips");
    controls.release("grips");
    controls.select(true);
    controls.releaseAll();
    const { hands } = desk.source.read(1);
    expect([hands.left.isSqueezing, hands.right.isSelecting]).toEqual([true, true]);
    const later = desk.source.read(1.5).hands;
    expect([later.left.isSqueezing, later.right.isSelecting]).toEqual([false, false]);
  });

  it("moves no faster than a body, whatever the mouse does", () => {
    const desk = new Desk();
    let before: Vector | null = null;
    let fastest = 0;
    desk.source.controls.isReaching = true;
    for (const pixels of [300, -900, 500]) {
      desk.source.controls.look(pixels, pixels / 3);
      desk.frames(0.5, (frame) => {
        const hand = at(frame, "RightHand");
        if (before !== null) fastest = Math.max(fastest, RATE_HZ * length(minus(hand, before)));
        before = hand;
      });
    }
    expect(fastest).toBeLessThan(8);
  });
});
