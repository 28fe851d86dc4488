import { describe, expect, it } from "vitest";
import { answered, type ItemTraces, pageShown } from "./draft";

type Step = readonly [atMs: number, item: string | "page", typed?: boolean];

/** The traces after a page was shown at 0 and these answers were given. */
function traced(steps: readonly Step[]): ItemTraces {
  let traces: ItemTraces = {};
  let turn = pageShown(0);
  for (const [atMs, item, typed = false] of steps) {
    if (item === "page") turn = pageShown(atMs);
    else ({ traces, turn } = answered(traces, turn, { item, typed }, atMs));
  }
  return traces;
}

describe("how an item was answered", () => {
  it("is timed from when its page was shown, then from the previous answer", () => {
    expect(
      traced([
        [2500, "a"],
        [4000, "b"],
        [9000, "page"],
        [9800, "c"],
      ]),
    ).toEqual({
      a: { response_s: 2.5, changes: 0 },
      b: { response_s: 1.5, changes: 0 },
      c: { response_s: 0.8, changes: 0 },
    });
  });

  it("keeps the first time and counts every later choice, immediate or after another item", () => {
    expect(
      traced([
        [2000, "a"],
        [2600, "a"],
        [5000, "b"],
        [6000, "a"],
      ]),
    ).toEqual({
      a: { response_s: 2, changes: 2 },
      b: { response_s: 2.4, changes: 0 },
    });
  });

  it("counts a word typed letter by letter as one answer, and a later edit as one change", () => {
    expect(
      traced([
        [1000, "t", true],
        [1200, "t", true],
        [1400, "t", true],
        [3000, "b"],
        [4000, "t", true],
        [4100, "t", true],
      ]),
    ).toEqual({
      t: { response_s: 1.4, changes: 1 },
      b: { response_s: 1.6, changes: 0 },
    });
  });

  it("counts a change of a typed answer on a page shown a second time", () => {
    expect(
      traced([
        [1000, "t", true],
        [5000, "page"],
        [5500, "t", true],
      ]).t,
    ).toEqual({ response_s: 1, changes: 1 });
  });
});
