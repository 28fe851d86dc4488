import { describe, expect, it } from "vitest";
import { alarmsDe, alarmsEn } from "./alarmTexts";
import { consentDe, consentEn } from "./consentTexts";
import { equipmentDe, equipmentEn } from "./equipmentTexts";
import { expertDe, expertEn } from "./expertTexts";
import { safetyDe, safetyEn } from "./safetyTexts";
import { validityDe, validityEn } from "./validityTexts";

type Table = Readonly<Record<string, string>>;
const TABLES: Readonly<Record<string, readonly [Table, Table]>> = {
  alarms: [alarmsEn, alarmsDe],
  consent: [consentEn, consentDe],
  equipment: [equipmentEn, equipmentDe],
  experts: [expertEn, expertDe],
  safety: [safetyEn, safetyDe],
  validity: [validityEn, validityDe],
};
const gaps = (text: string) => [...text.matchAll(/{{(\w+)}}/g)].map(([, name]) => name).sort();

describe.each(Object.entries(TABLES))("the texts of %s", (_, [en, de]) => {
  it("exist in both languages and have the same placeholders", () => {
    expect(Object.keys(de).sort()).toEqual(Object.keys(en).sort());
    for (const [key, text] of Object.entries(en)) {
      expect([key, text.trim() !== ""]).toEqual([key, true]);
      expect([key, gaps(de[key] ?? "")]).toEqual([key, gaps(text)]);
    }
  });
});
