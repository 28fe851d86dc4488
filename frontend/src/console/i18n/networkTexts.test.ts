import { describe, expect, it } from "vitest";
import { networkDe, networkEn } from "./networkTexts";

const placeholders = (text: string) =>
  [...text.matchAll(/{{(\w+)}}/g)].map(([, name]) => name).sort();

describe("the network's texts", () => {
  it("have the same placeholders in both languages", () => {
    for (const key of Object.keys(networkEn) as (keyof typeof networkEn)[])
      expect([key, placeholders(networkDe[key])]).toEqual([key, placeholders(networkEn[key])]);
  });
});
