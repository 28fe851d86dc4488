/** Texts of a study's versions and their differences. */
export const versionsEn = {
  "changes.broken": "Changes are shown once there are no problems",
  "diff.same": "The content is the same",
  "diff.identical": "There are no differences.",
  "diff.layout": "Only comments or layout differ; saving would not create a new version.",
  "diff.newLedger": "Balance is affected: new sessions start a new ledger",
  "diff.newLedger.body":
    "Conditions or orders differ. Slots that are filled stay with the old ledger and are not counted in the new one.",
  "diff.sameLedger": "Balance is not affected: the ledger continues",
  "diff.sameLedger.body": "Conditions and orders are the same.",
  "diff.underWay_one":
    "One session is planned or running; it keeps the version it was created with.",
  "diff.underWay_other":
    "{{count}} sessions are planned or running; they keep the version they were made with.",
  "diff.instruments": "Instruments whose wording differs:",
  "diff.text": "Text, line by line",
  "diff.place": "Place",
  "diff.before": "Before",
  "diff.after": "After",
  "diff.added": "added",
  "diff.removed": "removed",
  "diff.changed": "changed",
  "versions.tab": "Versions",
  "versions.lead":
    "Every content the study ever had. Sessions keep the version they were made with.",
  "versions.number": "Version",
  "versions.made": "Created",
  "versions.state": "State",
  "versions.compare": "Compare",
  "versions.from": "From version",
  "versions.to": "to version",
  "versions.one": "There is only one version so far, so nothing to compare it with.",
  "versions.edit": "Edit the study",
  "versions.duplicate": "Duplicate",
  "versions.duplicate.key": "Key of the copy",
  "versions.duplicate.hint":
    "Lower-case letters, digits, - and _. Ledger and sessions are its own.",
  "versions.archive": "Archive",
  "versions.archive.title": "Archive this study?",
  "versions.archive.body":
    "It takes no new sessions and leaves the list. Nothing is deleted: data, ledger and versions stay, and it can be restored.",
  "versions.restore": "Restore",
  "versions.archived": "Archived: it takes no new sessions",
  "versions.archived.body": "Data, ledger and versions are kept. Restore it to continue.",
  "versions.show": "Archived studies",
  "versions.hide": "Current studies",
  "versions.noneArchived": "No archived studies",
  "versions.noneArchived.body": "Studies that you archive on their page appear here.",
};

export const versionsDe: Readonly<Record<keyof typeof versionsEn, string>> = {
  "changes.broken": "Änderungen lassen sich nennen, sobald es keine Probleme gibt",
  "diff.same": "Der Inhalt ist derselbe",
  "diff.identical": "Kein Zeichen unterscheidet sich.",
  "diff.layout":
    "Nur Kommentare oder Anordnung unterscheiden sich; Speichern ergäbe keine neue Version.",
  "diff.newLedger": "Die Balance ist betroffen: Neue Sitzungen beginnen einen neuen Plan",
  "diff.newLedger.body":
    "Bedingungen oder Reihenfolgen unterscheiden sich. Belegte Plätze bleiben beim alten Plan und zählen im neuen nicht.",
  "diff.sameLedger": "Die Balance ist nicht betroffen: Der Plan geht weiter",
  "diff.sameLedger.body": "Bedingungen und Reihenfolgen sind dieselben.",
  "diff.underWay_one":
    "Eine Sitzung ist geplant oder läuft; sie behält die Version, mit der sie angelegt wurde.",
  "diff.underWay_other":
    "{{count}} Sitzungen sind geplant oder laufen; sie behalten die Version, mit der sie angelegt wurden.",
  "diff.instruments": "Instrumente, deren Wortlaut sich unterscheidet:",
  "diff.text": "Text, Zeile für Zeile",
  "diff.place": "Stelle",
  "diff.before": "Vorher",
  "diff.after": "Nachher",
  "diff.added": "hinzugefügt",
  "diff.removed": "entfernt",
  "diff.changed": "geändert",
  "versions.tab": "Versionen",
  "versions.lead":
    "Jeder Inhalt, den die Studie je hatte. Sitzungen behalten die Version, mit der sie angelegt wurden.",
  "versions.number": "Version",
  "versions.made": "Angelegt",
  "versions.state": "Zustand",
  "versions.compare": "Vergleichen",
  "versions.from": "Von Version",
  "versions.to": "zu Version",
  "versions.one": "Es gibt erst eine Version und nichts, womit sie zu vergleichen wäre.",
  "versions.edit": "Studie bearbeiten",
  "versions.duplicate": "Duplizieren",
  "versions.duplicate.key": "Schlüssel der Kopie",
  "versions.duplicate.hint":
    "Kleinbuchstaben, Ziffern, - und _. Plan und Sitzungen sind ihre eigenen.",
  "versions.archive": "Archivieren",
  "versions.archive.title": "Diese Studie archivieren?",
  "versions.archive.body":
    "Sie nimmt keine neuen Sitzungen auf und verlässt die Liste. Nichts wird gelöscht: Daten, Plan und Versionen bleiben, und sie lässt sich wiederherstellen.",
  "versions.restore": "Wiederherstellen",
  "versions.archived": "Archiviert: keine neuen Sitzungen",
  "versions.archived.body":
    "Daten, Plan und Versionen sind alle da. Stellen Sie sie wieder her, um weiterzumachen.",
  "versions.show": "Archivierte Studien",
  "versions.hide": "Aktuelle Studien",
  "versions.noneArchived": "Keine Studie ist archiviert",
  "versions.noneArchived.body": "Eine Studie, die auf ihrer Seite abgelegt wird, erscheint hier.",
};
