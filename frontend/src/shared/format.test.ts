import { describe, expect, it } from "vitest";
import { ago, clockFace, duration, latencyDifference, latencyWithin, number } from "./format";
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

  it("uses the notation of the language", () => {
    expect(number(1.0407, "en")).toBe("1.04");
    expect(number(1.0407, "de")).toBe("1,04");
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
