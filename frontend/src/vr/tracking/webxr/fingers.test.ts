import { length, minus, normalised, type Quaternion, type Vector } from "@shared/rotations";
import { describe, expect, it } from "vitest";
import { FINGER_VALUES, HAND_SIDES } from "../frameBuffer";
import { blendedFingers, GESTURES, type Gesture, gestureRotations, handJoints } from "../handShape";
import { turned } from "../places";
import { seeded } from "../script/random";
import { FINGER_JOINTS, handRotation, writeFingers } from "./fingers";
import { fistDetector, Hysteresis, openness, pinchDetector, pinchGapM } from "./pinch";

const HAND_M = 0.19;
const TURNED: Quaternion = normalised([0.3, -0.5, 0.7, 0.4]);

/** What tracking of a hand with these finger rotations gives. */
function tracked(side: "left" | "right", rotations: Float64Array, hand: Quaternion = TURNED) {
  const joints = handJoints(
    side,
    { positionM: [0.2, 1.1, -0.4], rotation: hand },
    rotations,
    HAND_M,
  );
  const of = (part: number | null): Quaternion => {
    const name = part === null ? "wrist" : (FINGER_JOINTS[part] as XRHandJoint);
    return joints.get(name)?.rotation as Quaternion;
  };
  const values = new Float64Array(FINGER_VALUES);
  writeFingers(side, of, values);
  const position = (name: XRHandJoint): Vector | null => joints.get(name)?.positionM ?? null;
  return { values, position, wrist: of(null), count: joints.size };
}

const gestures = Object.entries(GESTURES) as readonly (readonly [string, Gesture])[];

describe("Finger rotations from WebXR's joints", () => {
  it.each(HAND_SIDES)("of the %s hand are those of the hand that made the joints", (side) => {
    const random = seeded(11);
    for (let hand = 0; hand < 200; hand++) {
      const given = new Float64Array(FINGER_VALUES);
      for (let part = 0; part < 15; part++) {
        const drawn = normalised([
          2 + random.next(),
          random.normal(),
          random.normal(),
          random.normal(),
        ]);
        given.set(drawn, 4 * part);
      }
      const { values, wrist, count } = tracked(side, given);
      expect(count).toBe(25);
      for (let at = 0; at < FINGER_VALUES; at++)
        expect(values[at]).toBeCloseTo(given[at] as number, 12);
      expect(handRotation(side, wrist)).toEqual(TURNED.map((value) => expect.closeTo(value, 12)));
    }
  });

  it.each(HAND_SIDES)(
    "are all zero for a %s hand in the T-pose, as WebXR describes its joints",
    (side) => {
      const { values } = tracked(side, gestureRotations(side, GESTURES.flat), [1, 0, 0, 0]);
      for (let part = 0; part < 15; part++) {
        expect([...values.subarray(4 * part, 4 * part + 4)]).toEqual(
          [1, 0, 0, 0].map((one) => expect.closeTo(one, 12)),
        );
      }
    },
  );

  it("bend the fingers of a palm that faces down downwards, and mirror the two hands", () => {
    for (const [, gesture] of gestures) {
      const [left, right] = HAND_SIDES.map((side) =>
        tracked(side, gestureRotations(side, gesture), [1, 0, 0, 0]),
      );
      const tip = left?.position("middle-finger-tip") as Vector;
      const knuckle = left?.position("middle-finger-phalanx-proximal") as Vector;
      expect(tip[1]).toBeLessThanOrEqual(knuckle[1] + 1e-12);
      for (let part = 0; part < 15; part++) {
        const [w, x, y, z] = (left?.values ?? []).slice(4 * part, 4 * part + 4);
        const mirrored = [w, x, -(y as number), -(z as number)].map((one) =>
          expect.closeTo(one as number, 12),
        );
        expect([...(right?.values ?? []).slice(4 * part, 4 * part + 4)]).toEqual(mirrored);
      }
    }
  });

  it("do not depend on where the hand is or how it is turned", () => {
    const given = gestureRotations("left", GESTURES.point);
    const one = tracked("left", given, turned([0, 1, 0], 2)).values;
    expect([...tracked("left", given).values]).toEqual(
      [...one].map((value) => expect.closeTo(value, 12)),
    );
  });
});

describe("Gestures of tracked hands", () => {
  it.each(HAND_SIDES)(
    "a pinch and a fist of the %s hand are told apart from an open one",
    (side) => {
      const found = gestures.map(([name, gesture]) => {
        const { position } = tracked(side, gestureRotations(side, gesture));
        const isPinch = pinchDetector().at(0, pinchGapM(position));
        return [
          name,
          isPinch ? "pinch" : "",
          fistDetector().at(0, openness(position)) ? "fist" : "",
        ];
      });
      expect(found).toEqual([
        ["flat", "", ""],
        ["relaxed", "", ""],
        ["fist", expect.any(String), "fist"],
        ["point", expect.any(String), "fist"],
        ["pinch", "pinch", ""],
      ]);
    },
  );

  it("one slow pinch with trembling tips is one pinch", () => {
    const random = seeded(4);
    const detector = pinchDetector();
    const [open, closed] = [GESTURES.relaxed, GESTURES.pinch].map((one) =>
      gestureRotations("right", one),
    ) as [Float64Array, Float64Array];
    let changes = 0;
    let before = false;
    for (let frame = 0; frame < 360; frame++) {
      const share = Math.sin((Math.PI * frame) / 360);
      const { position } = tracked("right", blendedFingers(open, closed, share));
      const isOn = detector.at(frame / 90, pinchGapM(position) + 0.002 * random.normal());
      if (isOn !== before) changes++;
      before = isOn;
    }
    expect([changes, before]).toEqual([2, false]);
  });

  it("keeps a state for 150 ms, and while the joints are not seen", () => {
    const one = new Hysteresis(0.02, 0.034);
    expect(one.at(0, 0.01)).toBe(true);
    expect(one.at(0.1, 0.05)).toBe(true);
    expect(one.at(0.2, Number.NaN)).toBe(true);
    expect(one.at(0.21, 0.03)).toBe(true);
    expect(one.at(0.22, 0.05)).toBe(false);
    expect(one.at(0.3, 0.01)).toBe(false);
    expect(one.at(0.37, 0.01)).toBe(true);
    one.release();
    expect(one.at(0.38, 0.05)).toBe(false);
  });

  it("knows a gap of tips in metres", () => {
    const { position } = tracked("left", gestureRotations("left", GESTURES.flat));
    const gap = length(
      minus(position("thumb-tip") as Vector, position("index-finger-tip") as Vector),
    );
    expect(pinchGapM(position)).toBe(gap);
    expect(gap).toBeGreaterThan(0.06);
  });
});
