import { describe, expect, it } from "vitest";
import { floorOf, NOWHERE, reaching } from "./floor";

describe("the floor", () => {
  it("grows by whole metres with the way of a body, and only then", () => {
    const still = reaching(NOWHERE, [0.4, -0.3]);
    expect(still).toBe(NOWHERE);
    const walked = reaching(still, [0.1, -3.6]);
    expect(walked).toEqual({ min: [0, -4], max: [0, 0] });
    expect(floorOf(1, 1.9, walked)).toMatchObject({ min: [-1, -5], max: [1, 1], step: 1 });
    expect(reaching(walked, [0, -2])).toBe(walked);
  });

  it("stays finite under a body that is lost", () => {
    expect(reaching(NOWHERE, [Number.NaN, 0])).toBe(NOWHERE);
    expect(reaching(NOWHERE, [1e9, 0]).max[0]).toBeLessThan(100);
  });
});
