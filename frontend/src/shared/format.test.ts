import { describe, expect, it } from "vitest";
import {
  ago,
  clockFace,
  decimals,
  duration,
  latencyDifference,
  latencyWithin,
  measuredTime,
  number,
} from "./format";
import { milliseconds, seconds } from "./units";

describe("formatting", () => {
  it("truncates a clock's seconds instead of rounding them up", () => {
    expect(clockFace(seconds(59.99))).toBe("0:59");
    expect(clockFace(seconds(60))).toBe("1:00");
    expect(clockFace(seconds(-1))).toBe("0:00");
  });

  it("writes a duration with its units", () => {
    expect([45, 120, 125, 3600, 3900].map((time) => duration(seconds(time)))).toEqual([
      "45 s",
      "2 min",
      "2 min 5 s",
      "1 h",
      "1 h 5 min",
    ]);
  });

  it("writes a measured time in the unit that suits it", () => {
    const written = [0, 0.0445, 0.99994, 0.99996, 1.25, 59.994, 59.996, 75].map((time) =>
      measuredTime(seconds(time), "en"),
    );
    expect(written).toEqual([
      "0.0 ms",
      "44.5 ms",
      "999.9 ms",
      "1.00 s",
      "1.25 s",
      "59.99 s",
      "1 min",
      "1 min 15 s",
    ]);
    expect(measuredTime(seconds(0.05), "en", number)).toBe("50 ms");
    expect(measuredTime(seconds(12.5), "de")).toBe("12,50 s");
  });

  it("uses the notation of the language", () => {
    expect(number(1.0407, "en")).toBe("1.04");
    expect(number(1.0407, "de")).toBe("1,04");
  });

  it("gives every value the same decimals, and no sign to what rounds to zero", () => {
    const written = [-0.25, -0.0004, 0, 8].map((value) => decimals(value, "en", 3));
    expect(written).toEqual(["−0.250", "0.000", "0.000", "8.000"]);
  });

  it("writes a measured latency with its uncertainty, which is never rounded down", () => {
    const within = (value: number, half: number, language: string) =>
      latencyWithin(milliseconds(value), milliseconds(half), language);
    expect(within(124.98, 0.05, "en")).toBe("125.0 ± 0.1 ms");
    expect(within(350.16, 0.21, "de")).toBe("350,2 ± 0,3 ms");
    expect(within(-0.04, 0.05, "en")).toBe("0.0 ± 0.1 ms");
    expect(within(-12.34, 1, "en")).toBe("−12.3 ± 1.0 ms");
  });

  it("writes a difference with its sign", () => {
    expect(latencyDifference(milliseconds(20), "en")).toBe("+20.0 ms");
    expect(latencyDifference(milliseconds(-20.26), "de")).toBe("−20,3 ms");
  });

  it("writes how long ago something was", () => {
    const now = new Date("2026-01-01T12:00:42Z");
    expect(ago("2026-01-01T12:00:00Z", now, "en")).toContain("42");
    expect(ago("2026-01-01T10:00:00Z", now, "de")).toContain("2");
  });
});
