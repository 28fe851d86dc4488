import { describe, expect, it } from "vitest";
import { capturesDe, capturesEn } from "./captureTexts";
import { captureViewDe, captureViewEn } from "./captureViewTexts";
import { jointMapDe, jointMapEn } from "./jointMapTexts";
import { verificationDe, verificationEn } from "./verificationTexts";

const TABLES: readonly [
  string,
  Readonly<Record<string, string>>,
  Readonly<Record<string, string>>,
][] = [
  ["captures", capturesEn, capturesDe],
  ["one capture", captureViewEn, captureViewDe],
  ["joint maps", jointMapEn, jointMapDe],
  ["the verification", verificationEn, verificationDe],
];
const placeholders = (text = "") => [...text.matchAll(/{{(\w+)}}/g)].map(([, name]) => name).sort();

describe.each(TABLES)("the texts of %s", (_, en, de) => {
  it("have the same placeholders in both languages, and none is empty", () => {
    expect(Object.keys(de).sort()).toEqual(Object.keys(en).sort());
    for (const key of Object.keys(en)) {
      expect([key, placeholders(de[key])]).toEqual([key, placeholders(en[key])]);
      expect(en[key]?.trim() !== "" && de[key]?.trim() !== "").toBe(true);
    }
  });
});
