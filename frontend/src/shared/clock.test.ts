import { describe, expect, it } from "vitest";
import { activeAt, type ClockReport, HOLD_AFTER, isHolding } from "./clock";
import { milliseconds, seconds } from "./units";

const report: ClockReport = {
  active: seconds(20),
  duration: seconds(60),
  running: true,
  timeScale: 1,
  receivedAt: milliseconds(1000),
};
const at = (ms: number) => milliseconds(ms);

describe("the clock of a phase", () => {
  it("never runs backwards", () => {
    const times = [900, 1000, 1200, 3000, 9000].map((ms) => activeAt(report, at(ms)));
    expect(times).toEqual([...times].sort((a, b) => a - b));
  });

  it("carries a running report forward second by second", () => {
    expect(activeAt(report, at(2500))).toBeCloseTo(21.5);
  });

  it("stands still while the phase is paused", () => {
    expect(activeAt({ ...report, running: false }, at(60_000))).toBe(20);
  });

  it("holds, and says so, when no more reports arrive", () => {
    const late = at(1000 + HOLD_AFTER + 60_000);
    expect(activeAt(report, late)).toBeCloseTo(20 + HOLD_AFTER / 1000);
    expect(isHolding(report, late)).toBe(true);
    expect(isHolding(report, at(1100))).toBe(false);
  });

  it("does not pass the end of the phase", () => {
    expect(activeAt({ ...report, active: seconds(59.5) }, at(3000))).toBe(60);
  });

  it("has no end if the phase has none", () => {
    expect(activeAt({ ...report, active: seconds(100), duration: null }, at(2000))).toBe(101);
  });

  it("runs faster in a simulated session with a time scale", () => {
    expect(activeAt({ ...report, timeScale: 20 }, at(2000))).toBe(40);
  });
});
