import { describe, expect, it } from "vitest";
import { auditDe, auditEn } from "./auditTexts";
import { joinDe, joinEn } from "./joinTexts";
import { peopleDe, peopleEn } from "./peopleTexts";

const en: Readonly<Record<string, string>> = { ...peopleEn, ...joinEn, ...auditEn };
const de: Readonly<Record<string, string>> = { ...peopleDe, ...joinDe, ...auditDe };
const placeholders = (text: string | undefined) =>
  [...(text ?? "").matchAll(/{{(\w+)}}/g)].map(([, name]) => name).sort();

describe("the texts of people, invitations and audit trail", () => {
  it.each(Object.keys(en))("fill in the same values in both languages: %s", (key) => {
    expect(placeholders(de[key])).toEqual(placeholders(en[key]));
  });
});
