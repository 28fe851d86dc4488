/** Texts that every page has: a part of it could not be loaded, or it has failed. */
export const pageEn = {
  "page.older": "This page is older than the server",
  "page.older.body":
    "Reembody was updated while this page was open, and the part that is needed now is no longer there in the old version.",
  "page.older.remedy": "Save what you have entered, then reload the page.",
  "page.unreachable": "The server is not responding",
  "page.unreachable.body":
    "The part that is needed now was not loaded before, and the server does not answer.",
  "page.unreachable.remedy":
    "Check that the server is running and that this device is on its network, then press Reload.",
  "page.unknown": "A part of this page could not be loaded",
  "page.unknown.body": "The server answers, but this part of the page did not arrive.",
  "page.unknown.remedy": "Reload the page. If that does not help, restart the server.",
  "page.looking": "Finding out why a part of this page could not be loaded",
  "page.broken": "Something went wrong on this page",
  "page.broken.body": "A fault of Reembody: {{message}}",
  "page.broken.remedy": "Reload the page. What is stored on the server is not affected.",
  "page.reload": "Reload",
  "page.later": "Later",
} as const;

export const pageDe: Readonly<Record<keyof typeof pageEn, string>> = {
  "page.older": "Diese Seite ist älter als der Server",
  "page.older.body":
    "Reembody wurde aktualisiert, während diese Seite offen war; den Teil, der jetzt gebraucht wird, gibt es in der alten Fassung nicht mehr.",
  "page.older.remedy": "Speichern Sie, was Sie eingegeben haben, und laden Sie die Seite neu.",
  "page.unreachable": "Der Server antwortet nicht",
  "page.unreachable.body":
    "Der Teil, der jetzt gebraucht wird, war noch nicht geladen, und der Server antwortet nicht.",
  "page.unreachable.remedy":
    "Prüfen Sie, ob der Server läuft und dieses Gerät in seinem Netz ist, und drücken Sie dann „Neu laden“.",
  "page.unknown": "Ein Teil dieser Seite konnte nicht geladen werden",
  "page.unknown.body": "Der Server antwortet, aber dieser Teil der Seite ist nicht angekommen.",
  "page.unknown.remedy": "Laden Sie die Seite neu. Hilft das nicht, starten Sie den Server neu.",
  "page.looking": "Es wird geprüft, warum ein Teil dieser Seite nicht geladen werden konnte",
  "page.broken": "Auf dieser Seite ist etwas schiefgegangen",
  "page.broken.body": "Ein Fehler in Reembody: {{message}}",
  "page.broken.remedy":
    "Laden Sie die Seite neu. Was auf dem Server gespeichert ist, ist nicht betroffen.",
  "page.reload": "Neu laden",
  "page.later": "Später",
};
