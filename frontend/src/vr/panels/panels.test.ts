import { describe, expect, it } from "vitest";
import { besideRad } from "./panels";

const degrees = (rad: number): number => (rad * 180) / Math.PI;
const halfViewRad = (aspect: number): number => Math.atan(aspect * Math.tan((35 * Math.PI) / 180));

describe("A panel beside the mirror", () => {
  it("stands in the headset where it leaves the whole mirror free", () => {
    expect(degrees(besideRad(null))).toBeCloseTo(32);
  });

  it("stands whole inside a window, in front of who looks where the window is narrow", () => {
    for (const [width, height] of [
      [1280, 680],
      [1180, 700],
      [640, 480],
      [400, 800],
    ] as const) {
      const halfRad = halfViewRad(width / height);
      const angleRad = besideRad(halfRad);
      if (angleRad > 0) expect(degrees(angleRad) + 24.5).toBeLessThan(degrees(halfRad));
      expect(angleRad).toBeGreaterThanOrEqual(0);
    }
    expect(besideRad(halfViewRad(0.5))).toBe(0);
    // A wide window stretches its edges.
    expect(degrees(besideRad(halfViewRad(1280 / 600))) + 24.5).toBeLessThan(42);
  });
});
