/** The console's texts in the reader's language, of which only one is loaded. */
import {
  type KeyOf,
  type Language,
  loadTranslations,
  preferredLanguage,
  type Texts,
  useTranslations,
} from "@shared/i18n/i18n";
import { pageDe, pageEn } from "@shared/ui/pageTexts";
import type { allEn } from "./tables";

export type Key = KeyOf<typeof allEn>;

const REMEMBERED = "reembody.console.language";
// Tests of modules that import these texts run where there is no storage.
const preferred = [globalThis.localStorage?.getItem(REMEMBERED) ?? [], navigator.languages].flat();

/** What can be said if the others cannot be loaded: that they cannot, and what to do. */
const SPARE = { en: pageEn, de: pageDe };
const TABLES = {
  en: () => import("virtual:texts/en"),
  de: () => import("virtual:texts/de"),
};

const table = async (language: Language): Promise<Readonly<Record<string, string>>> => {
  try {
    return (await TABLES[language]()).default;
  } catch {
    return SPARE[language];
  }
};

/** `loaded` is to be awaited before the first page is drawn. */
export const { translations, loaded } = loadTranslations(table, preferredLanguage(preferred));
translations.on("languageChanged", (language) => {
  globalThis.localStorage?.setItem(REMEMBERED, language);
});

export const useTexts = (): Texts<Key> => useTranslations<Key>();
