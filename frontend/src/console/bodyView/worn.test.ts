import type { PointMotion } from "@shared/stage/motion";
import { describe, expect, it } from "vitest";
import { hipsScaleOf } from "./worn";

const motion = (hips: readonly number[]): PointMotion => ({
  kind: "skeleton",
  names: ["Hips", "Head"],
  parents: [-1, 0],
  frames: hips.length,
  rateHz: 1,
  recordedRateHz: 1,
  positions: Float32Array.from(hips.flatMap((height) => [0, height, 0, 0, 1.6, 0])),
});

describe("the height of one body's hips over another's", () => {
  it("is that of the first frame that both have, and 1 if there is none", () => {
    expect(hipsScaleOf(motion([Number.NaN, 0.8]), motion([0.9, 1.0]))).toBeCloseTo(0.8, 6);
    expect(hipsScaleOf(motion([Number.NaN]), motion([0.9]))).toBe(1);
    expect(hipsScaleOf(motion([0.9]), motion([0]))).toBe(1);
  });
});
