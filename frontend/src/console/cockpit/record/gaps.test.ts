import { describe, expect, it } from "vitest";
import { shownGaps } from "./gaps";

describe("the gaps of a stream", () => {
  it("are told with both ends, since a seq after the last one is not missing", () => {
    expect(shownGaps([[30, 45]])).toEqual({ shown: [{ first: 30, last: 44 }], more: 0 });
    expect(shownGaps([])).toEqual({ shown: [], more: 0 });
  });

  it("are the four longest in their order; the others are counted", () => {
    const gaps = [
      [1, 2],
      [10, 40],
      [50, 52],
      [60, 70],
      [80, 85],
      [90, 91],
    ] as const;
    const { shown, more } = shownGaps(gaps);
    expect(shown.map(({ first }) => first)).toEqual([10, 50, 60, 80]);
    expect(more).toBe(2);
  });
});
