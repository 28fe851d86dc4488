import {
  createTranslations,
  type KeyOf,
  preferredLanguage,
  type Texts,
  useTranslations,
} from "@shared/i18n/i18n";
import { languageOf, stateInPage } from "../stateInPage";
import { de } from "./de";
import { en } from "./en";

export type Key = KeyOf<typeof en>;

const firstState = stateInPage();

/** The session's language, or the browser's until the session says which language it is held in. */
export const translations = createTranslations(
  { en, de },
  firstState === undefined ? preferredLanguage(navigator.languages) : languageOf(firstState),
);

export const useTexts = (): Texts<Key> => useTranslations<Key>();
