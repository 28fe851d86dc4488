import { describe, expect, it } from "vitest";
import { editorDe, editorEn } from "./editorTexts";
import { fieldsDe, fieldsEn } from "./fieldTexts";
import { instrumentsDe, instrumentsEn } from "./instrumentTexts";
import { studyDe, studyEn } from "./studyTexts";
import { versionsDe, versionsEn } from "./versionTexts";

const placeholders = (text: string | undefined) =>
  [...(text ?? "").matchAll(/{{(\w+)}}/g)].map(([, name]) => name).sort();

const en: Readonly<Record<string, string>> = {
  ...editorEn,
  ...fieldsEn,
  ...versionsEn,
  ...studyEn,
  ...instrumentsEn,
};
const de: Readonly<Record<string, string>> = {
  ...editorDe,
  ...fieldsDe,
  ...versionsDe,
  ...studyDe,
  ...instrumentsDe,
};

describe("the texts of studies, editor and library", () => {
  it("exist in both languages", () => {
    expect(Object.keys(de).sort()).toEqual(Object.keys(en).sort());
    expect(Object.keys(en).filter((key) => !en[key]?.trim() || !de[key]?.trim())).toEqual([]);
  });

  it("have the same placeholders in both languages", () => {
    for (const key of Object.keys(en))
      expect([key, placeholders(de[key])]).toEqual([key, placeholders(en[key])]);
  });
});
