import { NO_GOALS } from "@shared/avatar/goals";
import type { Place } from "@shared/avatar/hips";
import { length, minus, plus, type Vector } from "@shared/rotations";
import { describe, expect, it } from "vitest";
import { frameBuffer, lose, set } from "./frameBuffer";
import { onFloor, turned } from "./places";
import { SteadyGoals } from "./steady";
import type { TrackingDevice } from "./tracked";

const RATE_HZ = 90;
const at = (positionM: Vector, turnRad = 0): Place => ({
  positionM,
  rotation: turned([0, 1, 0], turnRad),
});

/** A person whose head and left hand move; `see` says what is tracked in a frame. */
class Follower {
  readonly steady = new SteadyGoals();
  timeS = 0;
  fastest = 0;
  private before: Vector | null = null;

  frame(head: Place, hand: Place | null, device: TrackingDevice = "controller"): Place | null {
    this.timeS += 1 / RATE_HZ;
    const frame = frameBuffer();
    frame.timeS = this.timeS;
    set(frame.parts.Head, head, "headset");
    if (hand === null) lose(frame.parts.LeftHand);
    else set(frame.parts.LeftHand, hand, device);
    const goal = this.steady.steady(frame, { ...NO_GOALS, Head: head, LeftHand: hand }).LeftHand;
    if (goal !== null && this.before !== null) {
      const speed = RATE_HZ * length(minus(goal.positionM, this.before));
      this.fastest = Math.max(this.fastest, speed);
    }
    this.before = goal?.positionM ?? null;
    return goal;
  }
}

const HEAD = at([0, 1.6, 0]);
const seconds = (s: number): number[] =>
  Array.from({ length: Math.round(s * RATE_HZ) }, (_, i) => i / RATE_HZ);

describe("Steady goals", () => {
  it("leave alone what is tracked", () => {
    const follower = new Follower();
    for (const s of seconds(1)) {
      const hand = at([Math.sin(9 * s), 1.1, -0.3], s);
      expect(follower.frame(HEAD, hand)).toEqual(hand);
    }
  });

  it("exchange a controller for a tracked hand beside it without a jump, and follow it meanwhile", () => {
    const follower = new Follower();
    const path = (s: number): Vector => [0.5 * s, 1.1, -0.3];
    for (const s of seconds(0.5)) follower.frame(HEAD, at(path(s)));
    let last: Place | null = null;
    for (const s of seconds(0.5)) {
      last = follower.frame(HEAD, at(plus(path(s + 0.5), [0, 0.06, 0.05]), 0.8), "hand");
    }
    // Of its own 0.5 m/s; a jump of 8 cm within a frame would be 7 m/s.
    expect(follower.fastest).toBeLessThan(1.2);
    expect(last).toEqual(at(plus(path(0.5 + 44 / RATE_HZ), [0, 0.06, 0.05]), 0.8));
  });

  it("hold a lost hand beside the head, give it up after a second, and fade it back", () => {
    const follower = new Follower();
    const hand = at([-0.2, 1.2, -0.4]);
    for (const _ of seconds(0.2)) follower.frame(HEAD, hand);
    const held: (Place | null)[] = seconds(0.8).map((s) =>
      follower.frame(at([0.5 * s, 1.6, 0]), null),
    );
    const end = held.at(-1)?.positionM as Vector;
    expect(end[0]).toBeCloseTo(-0.2 + 0.5 * (71 / RATE_HZ), 9);
    expect(end[1]).toBeCloseTo(1.2, 9);
    for (const _ of seconds(0.5)) follower.frame(HEAD, hand);
    expect(follower.fastest).toBeLessThan(4);
    expect(follower.frame(HEAD, hand)).toEqual(hand);
    const gone = seconds(1.2).map(() => follower.frame(HEAD, null));
    expect([gone[80], gone.at(-1)]).toEqual([expect.anything(), null]);
  });

  it("turn a lost hand with the head but do not nod it", () => {
    const follower = new Follower();
    for (const _ of seconds(0.2)) follower.frame(HEAD, at([0, 1.2, -0.5]));
    const nodding: Place = { positionM: [0, 1.6, 0], rotation: turned([1, 0, 0], -0.9) };
    expect(follower.frame(nodding, null)?.positionM[1]).toBeCloseTo(1.2, 9);
    const left = onFloor(0, 0, Math.PI / 2).rotation;
    const turnedAway = follower.frame({ positionM: [0, 1.6, 0], rotation: left }, null);
    expect(turnedAway?.positionM).toEqual([
      expect.closeTo(-0.5, 9),
      expect.any(Number),
      expect.closeTo(0, 9),
    ]);
  });

  it("fade to where everything is after the room was recentred or calibrated again", () => {
    const follower = new Follower();
    for (const _ of seconds(0.2)) follower.frame(HEAD, at([0, 1.2, -0.5]));
    follower.steady.restart();
    const moved = at([0.4, 1.2, -0.5], 0.3);
    const first = follower.frame(HEAD, moved);
    expect(first?.positionM).toEqual([expect.closeTo(0, 9), 1.2, -0.5]);
    for (const _ of seconds(0.4)) follower.frame(HEAD, moved);
    expect(follower.fastest).toBeLessThan(3);
    expect(follower.frame(HEAD, moved)).toEqual(moved);
  });

  it("leave hips that inverse kinematics infers to it", () => {
    const steady = new SteadyGoals();
    const frame = frameBuffer();
    set(frame.parts.Hips, at([0, 0.9, 0]), "tracker");
    expect(steady.steady(frame, { ...NO_GOALS, Hips: at([0, 0.9, 0]) }).Hips).not.toBeNull();
    lose(frame.parts.Hips);
    frame.parts.Hips.state = "inferred";
    frame.timeS = 1 / RATE_HZ;
    expect(steady.steady(frame, NO_GOALS).Hips).toBeNull();
  });
});
