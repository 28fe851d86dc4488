import { describe, expect, it } from "vitest";
import { de } from "./de";
import { en } from "./en";

const placeholders = (text: string) =>
  [...text.matchAll(/{{(\w+)}}/g)].map(([, name]) => name).sort();
const keys = Object.keys(en) as (keyof typeof en)[];

describe("the texts", () => {
  it("exist in both languages", () => {
    expect(Object.keys(de).sort()).toEqual(Object.keys(en).sort());
    expect(keys.filter((key) => en[key].trim() === "" || de[key].trim() === "")).toEqual([]);
  });

  it("have the same placeholders in both languages", () => {
    for (const key of keys)
      expect([key, placeholders(de[key])]).toEqual([key, placeholders(en[key])]);
  });
});
