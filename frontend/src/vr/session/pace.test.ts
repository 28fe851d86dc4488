import { describe, expect, it } from "vitest";
import { LEAST_RATE_HZ, Pace } from "./pace";

const paceOf = (intervalsS: readonly number[]): number | null => {
  const pace = new Pace();
  let timeS = 100;
  let told = pace.note(timeS);
  for (const intervalS of intervalsS) {
    timeS += intervalS;
    told = pace.note(timeS);
  }
  return told;
};

describe("The pace of pictures", () => {
  it("is told with its rate where the clock cannot run, and not any more once it can", () => {
    expect(paceOf([0.8, 0.8, 0.8, 0.8])).toBeCloseTo(1.25);
    expect(1.25).toBeLessThan(LEAST_RATE_HZ);
    expect(paceOf([0.8, 0.8, 0.8, 0.8, 0.1, 0.1])).toBeNull();
    expect(paceOf([0.4, 0.4, 0.4, 0.4, 0.4])).toBeNull();
  });

  it("says nothing about one stumble, or about a window that was in the background", () => {
    expect(paceOf([0.1, 0.1, 2, 0.1])).toBeNull();
    expect(paceOf([60, 90, 60, 120, 60])).toBeNull();
  });
});
