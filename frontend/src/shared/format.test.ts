import { describe, expect, it } from "vitest";
import { ago, clockFace, duration, number } from "./format";
import { seconds } from "./units";

describe("formats", () => {
  it("cut the clock's seconds off instead of rounding them up", () => {
    expect(clockFace(seconds(59.99))).toBe("0:59");
    expect(clockFace(seconds(60))).toBe("1:00");
    expect(clockFace(seconds(-1))).toBe("0:00");
  });

  it("write a length of time with its units", () => {
    expect([45, 120, 125, 3600, 3900].map((time) => duration(seconds(time)))).toEqual([
      "45 s",
      "2 min",
      "2 min 5 s",
      "1 h",
      "1 h 5 min",
    ]);
  });

  it("use the notation of the language", () => {
    expect(number(1.0407, "en")).toBe("1.04");
    expect(number(1.0407, "de")).toBe("1,04");
  });

  it("say how long ago something was", () => {
    const now = new Date("2026-01-01T12:00:42Z");
    expect(ago("2026-01-01T12:00:00Z", now, "en")).toContain("42");
    expect(ago("2026-01-01T10:00:00Z", now, "de")).toContain("2");
  });
});
