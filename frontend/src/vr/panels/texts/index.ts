/** Words in a participant's language, without React: the panels are drawn by ourselves. */
import type { KeyOf, Translate } from "@shared/i18n/i18n";
import { createInstance } from "i18next";
import { de } from "./de";
import { en } from "./en";

export type PanelKey = KeyOf<typeof en>;
export type PanelWords = Translate<PanelKey>;

/** The texts of the panels in a language; English for one that there are no texts in. */
export function panelWords(language: string): PanelWords {
  const instance = createInstance();
  void instance.init({
    lng: language === "de" ? "de" : "en",
    fallbackLng: "en",
    keySeparator: false,
    nsSeparator: false,
    interpolation: { escapeValue: false }, // Drawn on a canvas, never read as HTML.
    initAsync: false,
    resources: { en: { translation: en }, de: { translation: de } },
  });
  return (key, values) => instance.t(key as string, { ...values });
}
