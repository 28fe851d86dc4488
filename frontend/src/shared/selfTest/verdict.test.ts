/** Facts about verdicts as text: units, digits, order, and one sentence for each that is not ok. */
import { describe, expect, it } from "vitest";
import { verdictsDe, verdictsEn } from "./texts";
import { concerns, limitText, todoText, type Verdict, valueText } from "./verdict";

const words = (key: keyof typeof verdictsEn, values?: Readonly<Record<string, string | number>>) =>
  verdictsEn[key].replace("{{limit}}", String(values?.["limit"]));

const verdict = (changes: Partial<Verdict>): Verdict => ({
  code: "longest_frame",
  status: "ok",
  value: 0.0445,
  unit: "s",
  limit: 0.1,
  at_least: false,
  ...changes,
});

describe("a verdict as text", () => {
  it("reads value and limit in the units that suit them", () => {
    expect(valueText(words, verdict({}), "en")).toBe("44.5 ms");
    expect(limitText(words, verdict({}), "en")).toBe("at most 100 ms");
    const long = verdict({ value: 1.25 });
    expect(valueText(words, long, "en")).toBe("1.25 s");
    const loss = verdict({ code: "hands_loss", value: 0.5, limit: 2 });
    expect(valueText(words, loss, "de")).toBe("0,5 s");
    expect(limitText(words, loss, "en")).toBe("at most 2 s");
  });

  it("says rates, ratios and counts in their own units", () => {
    const rate = verdict({ code: "rendering_rate", value: 83.1, unit: "Hz", limit: 85.5 });
    expect(limitText(words, { ...rate, at_least: true }, "en")).toBe("at least 85.5 Hz");
    const speed = verdict({ code: "physics_speed", value: 3.42, unit: "", limit: 1.5 });
    expect(valueText(words, speed, "en")).toBe("3.4 ×");
    expect(valueText(words, verdict({ code: "unacknowledged", value: 3, unit: "" }), "en")).toBe(
      "3",
    );
  });

  it("says that a figure was not measured, instead of advice about its value", () => {
    const missing = verdict({ value: null, status: "fail" });
    expect(valueText(words, missing, "en")).toBe("not measured");
    const inHeadset = { mode: "immersive" } as const;
    expect(todoText(words, missing, inHeadset)).toBe(verdictsEn["selftest.none.do"]);
    const unworn = verdict({ code: "hands_tracked", value: null, status: "warn" });
    expect(todoText(words, unworn, inHeadset)).toBe(verdictsEn["selftest.none.unworn"]);
    expect(limitText(words, verdict({ limit: null }), "en")).toBeNull();
  });

  it("advises to wear, charge or cool nothing on a screen", () => {
    const advised = Object.keys(verdictsEn)
      .filter((key) => /^verdict\.\w+$/.test(key))
      .map((key) => key.slice("verdict.".length) as Verdict["code"])
      .filter((code) => !/loss|tracked|pose_rate/.test(code))
      .map((code) => todoText(words, verdict({ code, status: "warn" }), { mode: "screen" }));
    expect(advised.filter((text) => /headset|battery|router|controllers/.test(text))).toEqual([]);
  });

  it("puts failures before warnings and leaves out what is ok", () => {
    const all = (["warn", "ok", "fail"] as const).map((status) => verdict({ status }));
    expect(concerns(all).map(({ status }) => status)).toEqual(["fail", "warn"]);
  });

  it("has a name and advice for each code in both languages", () => {
    const names = Object.keys(verdictsEn).filter((key) => /^verdict\.\w+$/.test(key));
    expect(names).toHaveLength(15);
    for (const name of names) {
      expect(Object.keys(verdictsEn)).toContain(`${name}.do`);
      expect(verdictsDe[name as keyof typeof verdictsDe]).not.toBe("");
    }
  });
});
