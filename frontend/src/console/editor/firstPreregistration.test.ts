import { describe, expect, it } from "vitest";
import { firstPreregistration } from "./firstPreregistration";
import { blank } from "./schema";

const SCORES = { free_text: [], veq: ["ownership", "agency"], karas2020: ["agency"] };

const study = (latencies: readonly number[], questionnaires: readonly string[]) => ({
  conditions: latencies.map((latency_ms) => ({ key: `latency_${latency_ms}`, latency_ms })),
  orders: { design: "all_permutations", replicates: 4 },
  procedure: {
    block: {
      phases: questionnaires.map((questionnaire, at) => ({
        limb: at === 0 ? "hand" : "foot",
        questionnaire,
      })),
    },
  },
});

describe("a new preregistration", () => {
  it("tests the first score of the study's own questionnaire, by a test for two conditions", () => {
    expect(firstPreregistration(study([200, 0], ["veq"]), { slots: 12, scores: SCORES })).toEqual({
      alpha: 0.05,
      planned_n: 12,
      primary: {
        measure: "score",
        instrument: "veq",
        score: "ownership",
        limb: "hand",
        test: "against_reference",
        reference: "latency_0",
      },
    });
  });

  it("skips a questionnaire without scores, and has Friedman's test for three conditions", () => {
    const { primary } = firstPreregistration(study([0, 125, 350], ["free_text", "karas2020"]), {
      slots: null,
      scores: SCORES,
    });
    expect(primary).toEqual({
      measure: "score",
      instrument: "karas2020",
      score: "agency",
      limb: "foot",
      test: "friedman",
    });
  });

  it("tests completed tasks if nothing is scored", () => {
    const { primary } = firstPreregistration(study([0, 1, 2], ["free_text"]), {
      slots: null,
      scores: SCORES,
    });
    expect(primary).toEqual({ measure: "completions", limb: "hand", test: "friedman" });
  });

  it("plans as many people as the orders take, or a usual number", () => {
    const planned = (orders: object) =>
      firstPreregistration({ ...study([0, 1, 2], []), orders } as never, {
        slots: null,
        scores: {},
      }).planned_n;
    expect(planned({ design: "all_permutations", replicates: 4 })).toBe(24);
    expect(planned({ design: "williams", replicates: 2 })).toBe(12);
    expect(planned({ design: "explicit", replicates: 5, sequences: [["a"], ["b"]] })).toBe(10);
    expect(planned({})).toBe(12);
    expect(firstPreregistration({}, { slots: null, scores: {} }).primary).toEqual({
      measure: "completions",
      limb: "hand",
      test: "rm_anova",
    });
  });
});

describe("a blank number", () => {
  const limits = {
    kind: "number",
    whole: false,
    minimum: null,
    maximum: null,
    above: null,
  } as const;

  it("lies within its limits", () => {
    expect(blank({ ...limits, above: 0, maximum: 0.2 }, [])).toBeLessThanOrEqual(0.2);
    expect(blank({ ...limits, above: 0, maximum: 0.2 }, [])).toBeGreaterThan(0);
    expect(blank({ ...limits, above: 0, maximum: 120 }, [])).toBe(1);
    expect(blank({ ...limits, minimum: 2 }, [])).toBe(2);
    expect(blank(limits, [])).toBe(0);
  });
});
