/** The texts around the help pages; the pages themselves are in English. */
export const helpPagesEn = {
  "helpPages.title": "Help",
  "helpPages.menu": "Help pages",
  "helpPages.menu.hint": "About this page first, then everything else.",
  "helpPages.search": "Search headings",
  "helpPages.list": "Help pages",
  "helpPages.found_one": "{{count}} heading found",
  "helpPages.found_other": "{{count}} headings found",
  "helpPages.none": "No heading has these words.",
  "helpPages.keys": "/ searches, arrow keys move through the list, Esc clears the search.",
  "helpPages.language": "The help pages are in English.",
  "helpPages.unknown": "There is no such help page",
  "helpPages.unknown.body": "It may have another name now. Search for its headings on the left.",
  "helpPages.unknown.back": "To the first page",
  "helpPages.table": "Table",
  "helpPages.all": "Help pages",
} as const;

export const helpPagesDe: Readonly<Record<keyof typeof helpPagesEn, string>> = {
  "helpPages.title": "Hilfe",
  "helpPages.menu": "Hilfeseiten",
  "helpPages.menu.hint": "Zuerst zu dieser Seite, dann alles andere.",
  "helpPages.search": "Überschriften durchsuchen",
  "helpPages.list": "Hilfeseiten",
  "helpPages.found_one": "{{count}} Überschrift gefunden",
  "helpPages.found_other": "{{count}} Überschriften gefunden",
  "helpPages.none": "Keine Überschrift enthält diese Wörter.",
  "helpPages.keys": "/ sucht, Pfeiltasten gehen durch die Liste, Esc leert die Suche.",
  "helpPages.language": "Die Hilfeseiten gibt es nur auf Englisch.",
  "helpPages.unknown": "Diese Hilfeseite gibt es nicht",
  "helpPages.unknown.body":
    "Vielleicht heißt sie jetzt anders. Suchen Sie links nach ihren Überschriften.",
  "helpPages.unknown.back": "Zur ersten Seite",
  "helpPages.table": "Tabelle",
  "helpPages.all": "Hilfeseiten",
};
