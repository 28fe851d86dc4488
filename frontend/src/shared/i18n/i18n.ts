/**
 * Two languages, each a flat table of texts. The German table has the type of the English one, so a
 * missing text does not compile.
 */
import { createInstance, type i18n } from "i18next";
import { initReactI18next, useTranslation } from "react-i18next";

export type Language = "en" | "de";
export const LANGUAGES: readonly Language[] = ["en", "de"];
export const LANGUAGE_NAMES: Readonly<Record<string, string>> = { en: "English", de: "Deutsch" };

type Table = Readonly<Record<string, string>>;
type Plural<Key> = Key extends `${infer Stem}_${"one" | "other"}` ? Stem : Key;
type Values = Readonly<Record<string, string | number>>;

/** The keys of a table as they are requested: plural forms by their stem. */
export type KeyOf<Texts extends Table> = Plural<keyof Texts & string>;
export type Translate<Key extends string> = (key: Key, values?: Values) => string;

export function createTranslations(tables: Record<Language, Table>, language: Language): i18n {
  const instance = createInstance();
  void instance.use(initReactI18next).init({
    lng: language,
    fallbackLng: "en",
    keySeparator: false,
    nsSeparator: false,
    interpolation: { escapeValue: false }, // React escapes
    initAsync: false,
    resources: { en: { translation: tables.en }, de: { translation: tables.de } },
  });
  return instance;
}

/**
 * Translations whose table is loaded when its language is chosen, which shows as soon as it is there.
 * `load` must not fail; `loaded` is fulfilled once the first table is there.
 */
export function loadTranslations(
  load: (language: Language) => Promise<Table>,
  language: Language,
): { readonly translations: i18n; readonly loaded: Promise<unknown> } {
  const translations = createInstance();
  const loaded = translations
    .use(initReactI18next)
    .use({
      type: "backend",
      init: () => {},
      read: (asked: string, _namespace: string, done: (error: null, table: Table) => void) => {
        void load(asked === "de" ? "de" : "en").then((table) => done(null, table));
      },
    })
    .init({
      lng: language,
      // Every language has every text.
      fallbackLng: false,
      keySeparator: false,
      nsSeparator: false,
      interpolation: { escapeValue: false }, // React escapes
    });
  return { translations, loaded };
}

export interface Texts<Key extends string> {
  readonly t: Translate<Key>;
  readonly language: Language;
  readonly setLanguage: (language: Language) => void;
}

/** Return the texts of the page; each family of pages calls it with its own keys. */
export function useTranslations<Key extends string>(): Texts<Key> {
  const { t, i18n } = useTranslation();
  return {
    t: (key, values) => t(key as string, { ...values }),
    language: i18n.language === "de" ? "de" : "en",
    setLanguage: (language) => void i18n.changeLanguage(language),
  };
}

/** The browser's language if it is supported, otherwise English. */
export function preferredLanguage(preferred: readonly string[]): Language {
  for (const tag of preferred) {
    const supported = LANGUAGES.find((language) => tag.toLowerCase().startsWith(language));
    if (supported !== undefined) return supported;
  }
  return "en";
}
