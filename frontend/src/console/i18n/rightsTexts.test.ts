import { describe, expect, it } from "vitest";
import { rightsDe, rightsEn } from "./rightsTexts";

const placeholders = (text: string) =>
  [...text.matchAll(/{{(\w+)}}/g)].map(([, name]) => name).sort();
const keys = Object.keys(rightsEn) as (keyof typeof rightsEn)[];

describe("the texts of participants' rights", () => {
  it("have the same placeholders in both languages, and none is empty", () => {
    expect(Object.keys(rightsDe).sort()).toEqual([...keys].sort());
    for (const key of keys) {
      expect([key, placeholders(rightsDe[key])]).toEqual([key, placeholders(rightsEn[key])]);
      expect(rightsEn[key].trim() !== "" && rightsDe[key].trim() !== "").toBe(true);
    }
  });
});
