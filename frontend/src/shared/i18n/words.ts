/** Words in a language that is given, without React: for what is drawn by ourselves. */
import { createInstance } from "i18next";
import type { KeyOf, Language, Translate } from "./i18n";

/** The texts of two tables in a language; English for one that there are no texts in. */
export function wordsIn<Table extends Readonly<Record<string, string>>>(
  tables: Readonly<Record<Language, Readonly<Record<keyof Table, string>>>>,
  language: string,
): Translate<KeyOf<Table>> {
  const instance = createInstance();
  void instance.init({
    lng: language === "de" ? "de" : "en",
    fallbackLng: "en",
    keySeparator: false,
    nsSeparator: false,
    interpolation: { escapeValue: false }, // Drawn on a canvas, never read as HTML.
    initAsync: false,
    resources: { en: { translation: tables.en }, de: { translation: tables.de } },
  });
  return (key, values) => instance.t(key as string, { ...values });
}
