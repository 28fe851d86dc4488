import { describe, expect, it } from "vitest";
import { replayDe, replayEn } from "./replayTexts";

const placeholders = (text: string) =>
  [...text.matchAll(/{{(\w+)}}/g)].map(([, name]) => name).sort();
const keys = Object.keys(replayEn) as (keyof typeof replayEn)[];

describe("the texts of replays", () => {
  it("have the same placeholders in both languages, and none is empty", () => {
    expect(Object.keys(replayDe).sort()).toEqual([...keys].sort());
    for (const key of keys) {
      expect([key, placeholders(replayDe[key])]).toEqual([key, placeholders(replayEn[key])]);
      expect(replayEn[key].trim() !== "" && replayDe[key].trim() !== "").toBe(true);
    }
  });
});
