/** The texts without the library that the application has for them: no plural forms. */
import type { Language, Translate } from "@shared/i18n/i18n";
import { de } from "./de";
import { en } from "./en";

const tables = { en, de };

export const plainTexts =
  (language: Language): Translate<keyof typeof en> =>
  (key, values = {}) =>
    tables[language][key].replace(/{{(\w+)}}/g, (_, name: string) => String(values[name] ?? ""));
