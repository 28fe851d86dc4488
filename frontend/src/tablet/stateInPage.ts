import type { TabletState } from "@shared/api/types";
import type { Language } from "@shared/i18n/i18n";

/** The screen that the server has written into the page, which a paired tablet shows at once. */
export function stateInPage(): TabletState | undefined {
  const text = document.getElementById("first-answer")?.textContent;
  if (!text) return undefined;
  return (JSON.parse(text) as { readonly state: TabletState | null }).state ?? undefined;
}

/** The language of the tablet's own texts beside those of a session in any language. */
export const languageOf = ({ language }: TabletState): Language =>
  language === "de" ? "de" : "en";
