import { describe, expect, it } from "vitest";
import { editorDe, editorEn } from "./editorTexts";
import { instrumentsDe, instrumentsEn } from "./instrumentTexts";

const placeholders = (text: string | undefined) =>
  [...(text ?? "").matchAll(/{{(\w+)}}/g)].map(([, name]) => name).sort();

describe("the texts of editor and library", () => {
  it("fill in the same values in both languages", () => {
    const en: Readonly<Record<string, string>> = { ...editorEn, ...instrumentsEn };
    const de: Readonly<Record<string, string>> = { ...editorDe, ...instrumentsDe };
    for (const key of Object.keys(en))
      expect([key, placeholders(de[key])]).toEqual([key, placeholders(en[key])]);
  });
});
