import {
  createTranslations,
  type KeyOf,
  preferredLanguage,
  type Texts,
  useTranslations,
} from "@shared/i18n/i18n";
import { de } from "./de";
import { en } from "./en";

export type Key = KeyOf<typeof en>;

/** The browser's language, until the session says which language it is held in. */
export const translations = createTranslations({ en, de }, preferredLanguage(navigator.languages));

export const useTexts = (): Texts<Key> => useTranslations<Key>();
