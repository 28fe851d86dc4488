import { describe, expect, it } from "vitest";
import { SleepWatch } from "./sleep";

const at = (x: number) => ({ positionM: [x, 1.6, 0], rotation: [1, 0, 0, 0] }) as const;

describe("sleep", () => {
  it("is a gap of half a second between two frames, and no shorter one", () => {
    const watch = new SleepWatch();
    const seen = [0, 0.49, 0.98, 1.48, 1.49].map((timeS) => watch.frame(timeS, at(timeS)));
    expect(seen).toEqual([null, null, null, "gap", null]);
  });

  it("is a head that does not move at all for two seconds, noticed once", () => {
    const watch = new SleepWatch();
    const seen = Array.from({ length: 300 }, (_, i) => watch.frame(i / 90, at(0)));
    expect(seen.flatMap((sleep, i) => (sleep === null ? [] : [[sleep, i / 90]]))).toEqual([
      ["still", 2],
    ]);
  });

  it("is over once the head moves by any amount, and can come again", () => {
    const watch = new SleepWatch();
    const x = (i: number) => (i < 200 || i > 210 ? 0 : 1e-9 * i);
    const seen = Array.from({ length: 500 }, (_, i) => watch.frame(i / 90, at(x(i))));
    expect(seen.filter((sleep) => sleep === "still")).toHaveLength(2);
  });

  it("is not a head whose place is unknown", () => {
    const watch = new SleepWatch();
    const seen = Array.from({ length: 300 }, (_, i) => watch.frame(i / 90, null));
    expect(new Set(seen)).toEqual(new Set([null]));
  });
});
