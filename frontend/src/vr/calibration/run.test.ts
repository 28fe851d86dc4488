import { length, minus, type Quaternion } from "@shared/rotations";
import { describe, expect, it } from "vitest";
import { type CalibratedPerson, calibrate } from "../testing/scriptedCalibration";
import { onFloor } from "../tracking/places";
import type { GoalPart } from "../tracking/tracked";

const STATUE: CalibratedPerson = {
  statureM: 1.75,
  spanM: 1.8,
  seed: 1,
  wears: "shins",
  restlessness: 0,
};

const angleRad = (a: Quaternion, b: Quaternion): number =>
  2 * Math.acos(Math.min(1, Math.abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3])));

describe("A calibration", () => {
  it.each([
    [1.505, 1.49],
    [1.75, 1.8],
    [1.855, 1.99],
  ])(
    "measures somebody of %f m with a span of %f m who stands like a statue to a millimetre",
    (statureM, spanM) => {
      const { calibration, trackerFromGoal } = calibrate({ ...STATUE, statureM, spanM }, null);
      expect(Math.abs(calibration.statureM - statureM)).toBeLessThan(1e-3);
      expect(Math.abs((calibration.spanM ?? 0) - spanM)).toBeLessThan(1e-3);
      for (const part of ["Head", "LeftHand", "RightHand"] as const) {
        const found = calibration.offsets[part]?.trackerFromGoal;
        const { positionM, rotation } = trackerFromGoal[part];
        expect(length(minus(found?.positionM ?? [9, 9, 9], positionM))).toBeLessThan(1e-3);
        expect(angleRad(found?.rotation ?? [0, 1, 0, 0], rotation)).toBeLessThan(1e-3);
      }
    },
  );

  it("finds how devices are worn, whichever way that is", () => {
    const wish = { ...STATUE, differing: 1, seed: 4 };
    const { calibration, trackerFromGoal } = calibrate(wish, null);
    for (const part of ["LeftLowerLeg", "RightLowerLeg"] as const) {
      const found = calibration.offsets[part]?.trackerFromGoal;
      // Who stands upright still bends the knees by 2 degrees: 1.4 cm at the knee.
      expect(
        length(minus(found?.positionM ?? [9, 9, 9], trackerFromGoal[part].positionM)),
      ).toBeLessThan(0.02);
    }
  });

  it("does not depend on where the room has its origin, nor on how it is turned", () => {
    const here = calibrate({ ...STATUE, restlessness: 1, differing: 1 }, null).calibration;
    const roomFromWorld = onFloor(2.4, -1.3, 2.2);
    const there = calibrate({ ...STATUE, restlessness: 1, differing: 1, roomFromWorld }, null);
    expect(there.calibration.statureM).toBeCloseTo(here.statureM, 9);
    expect(there.calibration.spanM ?? 0).toBeCloseTo(here.spanM ?? 0, 9);
    for (const [part, offset] of Object.entries(here.offsets)) {
      const other = there.calibration.offsets[part as GoalPart]?.trackerFromGoal;
      const { positionM, rotation } = offset.trackerFromGoal;
      expect(length(minus(other?.positionM ?? [9, 9, 9], positionM))).toBeLessThan(1e-6);
      expect(angleRad(other?.rotation ?? [0, 1, 0, 0], rotation)).toBeLessThan(1e-6);
    }
  });

  it("averages noise: its error grows with it, and stays far below it", () => {
    const errorM = (noiseM: number) => {
      const errors = [1, 2, 3, 4].map((seed) => {
        const { calibration } = calibrate({ ...STATUE, seed, noiseM }, null);
        return (calibration.statureM - STATUE.statureM) ** 2;
      });
      return Math.sqrt(errors.reduce((sum, one) => sum + one, 0) / errors.length);
    };
    const [none, some, much] = [errorM(0), errorM(0.002), errorM(0.006)];
    expect(none).toBeLessThan(0.001);
    expect(some).toBeLessThan(0.002);
    expect(much).toBeLessThan(0.003);
  });

  it.each([[["n_pose"]], [["t_pose"]], [["n_pose", "t_pose"]]] as const)(
    "notices knees that are bent in %j, and measures the stature upright",
    (during) => {
      const wish = { ...STATUE, restlessness: 1, bends: { during, by: 0.15 } };
      const { calibration, asked, wasRepeated } = calibrate(wish, null);
      expect(wasRepeated || asked.includes("t_pose bent_knees")).toBe(true);
      expect(Math.abs(calibration.statureM - 1.75)).toBeLessThan(0.01);
    },
  );

  it("asks for the controllers to be exchanged, and goes on as soon as they are", () => {
    const wish = { ...STATUE, swapped: "hands", swapsBack: true } as const;
    const { calibration, asked } = calibrate(wish, null);
    expect(asked).toContain("n_pose swapped_hands");
    expect(calibration.notices).not.toContain("swapped_hands");
  });

  it.each(["hands", "shins"] as const)(
    "uses %s that stay exchanged for the side that they are on, and says so",
    (swapped) => {
      const straight = calibrate(STATUE, null).calibration;
      const { calibration } = calibrate({ ...STATUE, swapped }, null);
      expect(calibration.notices).toContain(`swapped_${swapped}`);
      expect(calibration.spanM ?? 0).toBeCloseTo(straight.spanM ?? 0, 3);
      const part = swapped === "hands" ? "RightHand" : "RightLowerLeg";
      const [one, other] = [calibration, straight].map((c) => c.offsets[part]?.trackerFromGoal);
      expect(
        length(minus(one?.positionM ?? [9, 9, 9], other?.positionM ?? [0, 0, 0])),
      ).toBeLessThan(1e-3);
    },
  );

  it("uses tracked hands as they are, and says that no feet are tracked", () => {
    const { calibration } = calibrate({ ...STATUE, wears: "hands" }, null);
    expect(calibration.notices).toEqual(["waist_inferred", "feet_not_tracked"]);
    expect(calibration.offsets.LeftHand?.device).toBe("hand");
    expect(Math.abs((calibration.spanM ?? 0) - STATUE.spanM)).toBeLessThan(1e-3);
  });
});
