import { describe, expect, it } from "vitest";
import { hasInterval, latencyFigure, peopleIn } from "./figures";
import type { CohortFigures } from "./pilots";

type Phase = CohortFigures["phases"][number];

const phase = (latency_ms: number, share: number, more: Partial<Phase> = {}) =>
  ({ limb: "hand", latency_ms, people: 12, share_of_lowest: share, ...more }) as Phase;
const words = {
  latency: "ms",
  share: "%",
  published: "others",
  limb: (limb: string) => limb,
  language: "en",
};
const drawn = (phases: readonly Phase[]) =>
  (
    latencyFigure({ phases, published: [] } as unknown as CohortFigures, words) as {
      data: readonly { error_y?: { array: number[]; arrayminus: number[] } }[];
    }
  ).data[0];

describe("completions by latency", () => {
  it("have the intervals of their means, in per cent", () => {
    const bands = drawn([
      phase(0, 1, { share_low: 0.75, share_high: 1.25 }),
      phase(200, 0.5, { share_low: 0, share_high: 1.25 }),
    ])?.error_y;
    expect(bands?.array).toEqual([25, 75]);
    expect(bands?.arrayminus).toEqual([25, 50]);
  });

  it("have none where they are not known", () => {
    expect(drawn([phase(0, 1, { share_low: null, share_high: null })])?.error_y).toBeUndefined();
    expect(drawn([phase(0, 1)])?.error_y).toBeUndefined();
  });

  it("have none where everybody did alike, which is no certainty", () => {
    expect(hasInterval({ share_low: 0.6, share_high: 0.6 })).toBe(false);
    expect(hasInterval({ share_low: 0.5, share_high: 0.7 })).toBe(true);
  });

  it("have a decimal comma on their axes in German", () => {
    const figure = latencyFigure({ phases: [], published: [] } as unknown as CohortFigures, {
      ...words,
      language: "de",
    }) as { layout: { separators: string } };
    expect(figure.layout.separators).toBe(",.");
  });

  it("say how many people they are of", () => {
    expect(peopleIn([phase(0, 1), phase(200, 0.5)])).toBe("12");
    expect(peopleIn([phase(0, 1), phase(200, 0.5, { people: 11 })])).toBe("11–12");
  });
});
