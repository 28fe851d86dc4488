import { itIsTranslated } from "@shared/i18n/tableTests";
import { describe, expect, it } from "vitest";
import { layOut } from "../panels/surface/layout";
import { deviceName } from "./device";
import { PLAN, placeIn, planDurationS } from "./plan";
import { AWAITED } from "./preparation";
import type { SelfTestView, Verdict } from "./report";
import { type Progress, selfTestScreen } from "./screens";
import { selfTestDe, selfTestEn, selfTestWords } from "./texts";

/** About as wide as the panel's letters are. */
const measure = (text: string, sizeDmm: number): number => text.length * sizeDmm * 0.52;

const CODES = Object.keys(selfTestEn)
  .filter((key) => key.startsWith("verdict.") && !key.endsWith(".do"))
  .map((key) => key.slice("verdict.".length) as Verdict["code"]);

const verdict = (code: Verdict["code"], change: Partial<Verdict> = {}): Verdict => ({
  code,
  status: "fail",
  value: 12.34,
  unit: "s",
  limit: 0.25,
  at_least: false,
  ...change,
});

const viewOf = (verdicts: readonly Verdict[]): SelfTestView =>
  ({
    id: "a",
    status: "fail",
    worn: false,
    verdicts,
    report: { rendering: { mode: "immersive" } },
  }) as unknown as SelfTestView;

describe("the test's words", () => itIsTranslated(selfTestEn, selfTestDe));

describe("the plan", () => {
  it("lasts two minutes and leaves no time without something to do", () => {
    expect(planDurationS(PLAN)).toBe(120);
    expect(placeIn(PLAN, -0.001)).toBeNull();
    expect(placeIn(PLAN, 0)).toMatchObject({ movement: "look", number: 1, leftS: 120 });
    expect(placeIn(PLAN, 24.999)).toMatchObject({ movement: "look" });
    expect(placeIn(PLAN, 25)).toMatchObject({ movement: "hands", stepLeftS: 35, leftS: 95 });
    expect(placeIn(PLAN, 119.9)).toMatchObject({ movement: "free", number: 4 });
    expect(placeIn(PLAN, 120)).toBeNull();
  });
});

describe("the panel of the test", () => {
  it("fits in every state and language, also where every figure is bad", () => {
    const place = placeIn(PLAN, 70);
    if (place === null) throw new Error("The plan is shorter than 70 s.");
    const states: readonly Progress[] = [
      ...AWAITED.map((awaited) => ({ kind: "preparing", awaited, waitedS: 30 }) as const),
      { kind: "measuring", place, isScripted: true },
      { kind: "sending" },
      { kind: "kept" },
      { kind: "short" },
      { kind: "unseen" },
      { kind: "stored", view: viewOf(CODES.map((code) => verdict(code))) },
      { kind: "stored", view: viewOf([verdict("duration", { status: "ok" })]) },
    ];
    for (const language of ["en", "de"]) {
      const words = selfTestWords(language);
      for (const progress of states) {
        const { heightDmm, targets } = layOut(selfTestScreen(words, progress, language), measure);
        expect(heightDmm).toBeLessThan(1100);
        const named = targets.map(({ target }) => target);
        const ways = {
          preparing: 0,
          sending: 0,
          measuring: 1,
          kept: 1,
          short: 2,
          unseen: 2,
          stored: 2,
        };
        expect([progress.kind, named.length]).toEqual([progress.kind, ways[progress.kind]]);
      }
    }
  });

  it("is drawn anew only every ten seconds, so that drawing it is no load", () => {
    const words = selfTestWords("en");
    const drawn = new Set<string>();
    for (let tenths = 0; tenths < 1200; tenths++) {
      const place = placeIn(PLAN, tenths / 10);
      if (place === null) throw new Error("The plan is shorter than two minutes.");
      const progress = { kind: "measuring", place, isScripted: false } as const;
      drawn.add(JSON.stringify(selfTestScreen(words, progress, "en")));
    }
    // Twelve times, and once more where a step begins between two of them.
    expect(drawn.size).toBeLessThanOrEqual(12 + PLAN.length - 1);
  });
});

describe("the device's name", () => {
  it("is read from what its browser says of the system, and from nothing else", () => {
    const name = (system: string) =>
      deviceName(`Mozilla/5.0 (${system}) AppleWebKit/537.36 OculusBrowser/41.3 Chrome/142.0`);
    expect(name("X11; Linux x86_64; Quest 3")).toBe("Quest 3");
    expect(name("X11; Linux x86_64; PICO 4 Ultra")).toBe("PICO 4 Ultra");
    expect(name("Macintosh; Intel Mac OS X 10_15_7")).toBeNull();
    expect(deviceName("")).toBeNull();
  });
});
