import { describe, expect, it } from "vitest";
import { FINGER_PARTS, withFingers } from "./fingers";
import type { PointMotion } from "./motion";
import { numbersOf, poseOf } from "./skin/pose";

const names = ["Hips", "LeftHand", "RightHand"];
const parents = [-1, 0, 0];
const motion: PointMotion = {
  kind: "skeleton",
  ...{ names, parents, frames: 2, rateHz: 30, recordedRateHz: 30 },
  positions: new Float32Array(18),
  rotations: Int16Array.from({ length: 24 }, (_, at) => (at % 4 === 0 ? 32767 : 0)),
};

describe("a pose with fingers", () => {
  it("has every finger below its hand, and each part below the one before", () => {
    const whole = withFingers(names, parents);
    const above = (part: string) => whole.joints[whole.parents[whole.joints.indexOf(part)] ?? -1];
    expect(whole.joints.length).toBe(3 + 30);
    expect(above("LeftThumbProximal")).toBe("LeftHand");
    expect(above("RightLittleProximal")).toBe("RightHand");
    expect(above("RightLittleDistal")).toBe("RightLittleIntermediate");
  });

  it("reads the rotations of a frame, and shows straight fingers where they are unknown", () => {
    const fingers = new Int16Array(2 * 4 * FINGER_PARTS.length);
    const thumb = 4 * FINGER_PARTS.length + 4 * FINGER_PARTS.indexOf("LeftThumbDistal");
    fingers.set([0, 0, 32767, 0], thumb);
    const pose = poseOf({ ...motion, fingers });
    const values = new Float32Array(numbersOf(pose?.joints ?? []));
    pose?.read(1, values);
    const own = (part: string) => {
      const at = 3 + 4 * (pose?.joints.indexOf(part) ?? 0);
      return [...values.subarray(at, at + 4)];
    };
    expect(own("LeftThumbDistal")).toEqual([0, 0, 32767, 0]);
    expect(own("RightIndexDistal")).toEqual([1, 0, 0, 0]);
    expect(poseOf(motion)?.joints).toEqual(names);
  });
});
