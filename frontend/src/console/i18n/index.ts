import {
  createTranslations,
  type KeyOf,
  preferredLanguage,
  type Texts,
  useTranslations,
} from "@shared/i18n/i18n";
import { de } from "./de";
import { en } from "./en";
import { networkDe, networkEn } from "./networkTexts";

const allEn = { ...en, ...networkEn };
const allDe = { ...de, ...networkDe };

export type Key = KeyOf<typeof allEn>;

const REMEMBERED = "reembody.console.language";
const wanted = [localStorage.getItem(REMEMBERED) ?? [], navigator.languages].flat();

export const translations = createTranslations({ en: allEn, de: allDe }, preferredLanguage(wanted));
translations.on("languageChanged", (language) => localStorage.setItem(REMEMBERED, language));

export const useTexts = (): Texts<Key> => useTranslations<Key>();
