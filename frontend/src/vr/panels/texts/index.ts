/** Words in a participant's language, without React: the panels are drawn by ourselves. */
import type { KeyOf, Translate } from "@shared/i18n/i18n";
import { wordsIn } from "@shared/i18n/words";
import { de } from "./de";
import { en } from "./en";

export type PanelKey = KeyOf<typeof en>;
export type PanelWords = Translate<PanelKey>;

/** The texts of the panels in a language; English for one that there are no texts in. */
export const panelWords = (language: string): PanelWords =>
  wordsIn<typeof en>({ en, de }, language);
