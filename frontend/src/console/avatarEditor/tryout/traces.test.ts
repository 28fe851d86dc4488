import { describe, expect, it } from "vitest";
import { scaleOf } from "./scale";
import { Trace } from "./traces";

const RADIANS = Math.PI / 180;

describe("the trace of an axis", () => {
  it("keeps the last five seconds and sums them up in degrees", () => {
    const trace = new Trace();
    expect(trace.summary).toBeNull();
    trace.add(Float64Array.of(90 * RADIANS, 0, 10), 10);
    for (let tick = 0; tick < 500; tick++) {
      trace.add(Float64Array.of(20 * RADIANS, 17 * RADIANS, tick < 125 ? -10 : 4), 10);
    }
    expect(trace.length).toBe(500);
    const { summary } = trace;
    expect(summary?.errorDeg).toBeCloseTo(3, 9);
    expect(summary?.rmsErrorDeg).toBeCloseTo(3, 9);
    expect(summary?.greatestErrorDeg).toBeCloseTo(3, 9);
    expect(summary?.torqueNm).toBe(4);
    expect(summary?.saturated).toBe(0.25);
    expect(summary?.isSaturated).toBe(false);
  });

  it("was saturated at the limit of its time, not at that of now", () => {
    const trace = new Trace();
    trace.add(Float64Array.of(0, 0, 8, 0, 0, 8), 10);
    trace.add(Float64Array.of(0, 0, 2, 0, 0, -2), 2);
    expect([0, 1, 2, 3].map((at) => trace.isSaturatedAt(at))).toEqual([false, false, true, true]);
    expect(trace.summary).toMatchObject({ saturated: 0.5, isSaturated: true, limitNm: 2 });
  });

  it("has no summary where the model has no hinge", () => {
    const trace = new Trace();
    trace.add(Float64Array.of(Number.NaN, Number.NaN, Number.NaN), Number.NaN);
    expect(trace.summary).toBeNull();
  });
});

describe("the scale of a picture", () => {
  it("has round marks around all values and is never without extent", () => {
    expect(scaleOf(-12, 31, 1).marks).toEqual([-20, 0, 20, 40]);
    expect(scaleOf(0, 0, 1).marks).toEqual([-1, 0, 1]);
    const { low, high } = scaleOf(0.21, 0.22, 0.001);
    expect(low).toBeLessThanOrEqual(0.21);
    expect(high).toBeGreaterThanOrEqual(0.22);
  });
});
