import {
  createTranslations,
  type KeyOf,
  preferredLanguage,
  type Texts,
  useTranslations,
} from "@shared/i18n/i18n";
import { auditDe, auditEn } from "./auditTexts";
import { consentDe, consentEn } from "./consentTexts";
import { de } from "./de";
import { editorDe, editorEn } from "./editorTexts";
import { en } from "./en";
import { equipmentDe, equipmentEn } from "./equipmentTexts";
import { expertDe, expertEn } from "./expertTexts";
import { instrumentsDe, instrumentsEn } from "./instrumentTexts";
import { joinDe, joinEn } from "./joinTexts";
import { networkDe, networkEn } from "./networkTexts";
import { peopleDe, peopleEn } from "./peopleTexts";
import { rightsDe, rightsEn } from "./rightsTexts";
import { safetyDe, safetyEn } from "./safetyTexts";

const allEn = {
  ...en,
  ...peopleEn,
  ...joinEn,
  ...auditEn,
  ...networkEn,
  ...editorEn,
  ...instrumentsEn,
  ...rightsEn,
  ...safetyEn,
  ...consentEn,
  ...expertEn,
  ...equipmentEn,
};
const allDe = {
  ...de,
  ...peopleDe,
  ...joinDe,
  ...auditDe,
  ...networkDe,
  ...editorDe,
  ...instrumentsDe,
  ...rightsDe,
  ...safetyDe,
  ...consentDe,
  ...expertDe,
  ...equipmentDe,
};

export type Key = KeyOf<typeof allEn>;

const REMEMBERED = "reembody.console.language";
const wanted = [localStorage.getItem(REMEMBERED) ?? [], navigator.languages].flat();

export const translations = createTranslations({ en: allEn, de: allDe }, preferredLanguage(wanted));
translations.on("languageChanged", (language) => localStorage.setItem(REMEMBERED, language));

export const useTexts = (): Texts<Key> => useTranslations<Key>();
