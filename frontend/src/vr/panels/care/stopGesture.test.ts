import { describe, expect, it } from "vitest";
import { frameOf, type Wearing } from "../testing/pointing";
import { StopGesture, type StopRules } from "./stopGesture";

type Pose = Omit<Wearing, "timeS">;
const RAISED: Pose = { parts: { RightHand: [0.2, 1.9, -0.1] } };
const GRIPS: Pose = { left: { isSqueezing: true }, right: { isSqueezing: true } };
const CALM: Pose = {};

/** The seconds at which a stop was recognised, for poses that each last some seconds, at 90 Hz. */
function stops(...held: readonly (readonly [seconds: number, pose: Pose])[]): readonly number[] {
  const gesture = new StopGesture();
  const found: number[] = [];
  let frame = 0;
  for (const [seconds, pose] of held) {
    for (let at = 0; at < seconds * 90; at += 1, frame += 1) {
      const progress = gesture.update(frameOf({ timeS: frame / 90, ...pose }));
      if (progress?.share === 1) found.push(frame / 90);
    }
  }
  return found;
}

describe("stopping", () => {
  it("takes one second with a hand above the head, or with both grips", () => {
    expect(stops([2, RAISED])).toEqual([1]);
    expect(stops([1, CALM], [2, GRIPS])).toEqual([2]);
  });

  it("happens once, until the hands were down", () => {
    expect(stops([5, RAISED])).toHaveLength(1);
    expect(stops([1.5, RAISED], [0.5, CALM], [1.5, RAISED])).toHaveLength(2);
  });

  it("is taken back by lowering the hand or letting go in time", () => {
    expect(stops([0.9, RAISED], [0.5, CALM], [0.9, RAISED])).toEqual([]);
    expect(stops([0.9, GRIPS], [0.5, CALM], [0.9, GRIPS])).toEqual([]);
  });

  it("survives a hand that is not seen for a moment, but not for longer", () => {
    const unseen: Pose = { parts: {}, eyesM: null };
    expect(stops([0.5, RAISED], [0.1, unseen], [0.6, RAISED])).toHaveLength(1);
    expect(stops([0.5, RAISED], [0.3, unseen], [0.6, RAISED])).toEqual([]);
  });

  it("is not a reach at the height of the eyes, one grip, two fists, or both arms stretched out", () => {
    expect(stops([3, { parts: { RightHand: [0.2, 1.7, -0.4] } }])).toEqual([]);
    expect(stops([3, { left: { isSqueezing: true } }])).toEqual([]);
    const fist = { isSqueezing: true, holdsController: false };
    expect(stops([3, { left: fist, right: fist }])).toEqual([]);
    const arms = { LeftHand: [-0.8, 1.4, 0], RightHand: [0.8, 1.4, 0] } as const;
    expect(stops([3, { parts: arms }])).toEqual([]);
  });

  it("takes both hands at boxes as high as a raised hand, and nothing while it is off", () => {
    const gesture = (rules: StopRules, pose: Pose): boolean => {
      const one = new StopGesture();
      const frames = Array.from({ length: 200 }, (_, at) => frameOf({ timeS: at / 90, ...pose }));
      return frames.some((frame) => one.update(frame, rules)?.share === 1);
    };
    const both: Pose = { parts: { RightHand: [0.2, 1.9, -0.1], LeftHand: [-0.2, 1.9, -0.1] } };
    expect(gesture({ needsBothHands: true }, RAISED)).toBe(false);
    expect(gesture({ needsBothHands: true }, both)).toBe(true);
    expect(gesture({ needsBothHands: true }, GRIPS)).toBe(true);
    expect(gesture({ isOff: true }, GRIPS)).toBe(false);
  });

  it("does not count grips that were held while it was off, until they were let go", () => {
    const one = new StopGesture();
    const stopped: number[] = [];
    for (let frame = 0; frame < 5 * 90; frame++) {
      const timeS = frame / 90;
      const pose = timeS > 3 && timeS < 3.5 ? CALM : GRIPS;
      const progress = one.update(frameOf({ timeS, ...pose }), { isOff: timeS < 0.5 });
      if (progress?.share === 1) stopped.push(timeS);
    }
    expect(stopped).toEqual([4.5]);
  });

  it("shows how far it has come, from a quarter of a second on", () => {
    const gesture = new StopGesture();
    const at = (timeS: number) => gesture.update(frameOf({ timeS, ...RAISED }));
    expect(at(0)).toBeNull();
    expect(at(0.2)).toBeNull();
    expect(at(0.5)).toEqual({ share: 0.5, by: "hand" });
    expect(gesture.update(frameOf({ timeS: 0.9 }))).toBeNull();
  });
});
