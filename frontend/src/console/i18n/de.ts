/** The console's texts in German. */

import { formDe } from "@shared/forms/texts";
import { actionsDe } from "@shared/session/texts";
import { pageDe } from "@shared/ui/pageTexts";
import { alarmsDe } from "../cockpit/alarms/texts";
import { bodyPanelDe } from "../cockpit/body/texts";
import { companionDe } from "../cockpit/companion/texts";
import { sideDe } from "../cockpit/record/texts";
import { roadDe } from "../cockpit/road/texts";
import { commandsDe } from "../cockpit/session/texts";
import { sessionDe } from "../cockpit/step/texts";
import { labTrackersDe } from "../cockpit/trackers/texts";
import type { en } from "./en";

export const de: Record<keyof typeof en, string> = {
  ...pageDe,
  ...formDe,
  ...actionsDe,
  ...alarmsDe,
  ...commandsDe,
  ...sessionDe,
  ...bodyPanelDe,
  ...labTrackersDe,
  ...companionDe,
  ...roadDe,
  ...sideDe,
  "app.name": "Reembody",
  "app.studies": "Studien",
  "app.logout": "Abmelden",
  "app.signedInAs": "Angemeldet als {{name}} ({{role}})",
  "app.theme.dark": "Dunkle Darstellung",
  "app.theme.light": "Helle Darstellung",
  "app.language": "English",
  "actor.script": "Skript, für {{name}}",
  "app.skip": "Zum Inhalt springen",
  "error.unreachable": "Der Server antwortet nicht.",
  "error.unreachableRemedy":
    "Prüfen Sie, ob er läuft und ob dieser Rechner in seinem Netz ist. Auf dem Server ist nichts verloren gegangen.",
  "error.unexpected": "Auf dieser Seite ist etwas schiefgegangen.",
  "error.retry": "Noch einmal versuchen",
  "error.line": "Zeile",
  "error.fileChanged": "Die Datei {{name}} hat sich geändert, seit Sie sie gewählt haben.",
  "error.fileChangedRemedy":
    "Es wurde nichts gesendet. Wählen Sie die Datei noch einmal und senden Sie sie, wie sie jetzt ist.",
  "login.title": "Anmelden",
  "login.lead": "Re-Embodiment-Studien durchführen, beobachten und auswerten.",
  "login.username": "Benutzername",
  "login.password": "Passwort",
  "login.submit": "Anmelden",
  "login.hint":
    "Das erste Konto heißt admin. Sein Passwort wurde beim ersten Start des Servers einmal ausgegeben.",
  "action.close": "Schließen",
  "action.cancel": "Abbrechen",
  "action.copy": "Kopieren",
  "action.copied": "Kopiert",
  "action.stop": "Anhalten",
  "action.understood": "Verstanden",
  "kind.label": "Art der Sitzung",
  "kind.all": "Alle",
  "kind.people.one": "Teilnehmende Person",
  "kind.people": "Teilnehmende",
  "kind.simulated": "Simuliert",
  "kind.test": "Test",
  "kind.people.hint": "Eine teilnehmende Person. Zählt in der Balance und in jeder Abbildung.",
  "kind.simulated.hint":
    "Eine simulierte Person. Hat einen eigenen Plan und ist überall gekennzeichnet.",
  "kind.test.hint": "Ein Test der Geräte. Zählt nie.",
  "language.en": "Englisch",
  "language.de": "Deutsch",
  "status.planned": "Geplant",
  "status.active": "Läuft",
  "status.completed": "Abgeschlossen",
  "status.aborted": "Abgebrochen",
  "status.withdrawn": "Zurückgezogen",
  "order.label": "Reihenfolge der Latenzen:",
  "order.conditions": "Reihenfolge der Bedingungen:",
  "order.configured": "konfigurierter Körper",
  "order.hidden": "Reihenfolge verdeckt (verblindet)",
  "studies.lead":
    "Jede Studie ist ein versioniertes Studienprotokoll mit eigenem Plan und eigenen Sitzungen.",
  "studies.empty.title": "Noch keine Studien",
  "studies.empty.body":
    "Eine Studie ist eine YAML-Datei mit Bedingungen, Reihenfolgen, Ablauf und Texten. Fügen Sie sie hier hinzu; jedes Problem wird mit seiner Zeile gezeigt.",
  "studies.empty.file": "Eine fertige Studie zur zusätzlichen Latenz steht in der Datei",
  "import.title": "Studie hinzufügen",
  "import.titleVersion": "Version hinzufügen",
  "import.lead":
    "Wählen Sie die YAML-Datei einer Studie oder fügen Sie ihren Text ein. Sie wird geprüft, bevor etwas gespeichert wird.",
  "import.file": "Datei wählen",
  "import.noText": "„{{name}}“ ist keine Textdatei",
  "import.noText.body":
    "Eine Studie ist eine YAML-Datei (.yaml oder .yml). Wählen Sie eine andere Datei.",
  "import.orPaste": "oder den Text unten einfügen",
  "import.source": "Studie als YAML",
  "import.check": "Prüfen",
  "import.save": "Studie hinzufügen",
  "import.saveVersion": "Version hinzufügen",
  "import.fine": "Keine Probleme gefunden. Die Datei kann hinzugefügt werden.",
  "import.problems_one": "Es gibt ein Problem. Ein Klick führt zur Zeile.",
  "import.problems_other": "Es gibt {{count}} Probleme. Ein Klick führt zur Zeile.",
  "sessions.participant": "Person",
  "sessions.status": "Stand",
  "sessions.kind": "Art",
  "sessions.order": "Reihenfolge",
  "sessions.started": "Begonnen",
  "sessions.duration": "Dauer",
  "sessions.anyStatus": "Jeder Stand",
  "sessions.step": "Schritt {{number}} von {{total}}:",
  "sessions.noMatch": "Keine Sitzung passt",
  "sessions.noMatch.body_one": "{{count}} Sitzung wird nicht gezeigt.",
  "sessions.noMatch.body_other": "{{count}} Sitzungen werden nicht gezeigt.",
  "sessions.showAll": "Alle zeigen",
  "sessions.notStarted": "noch nicht begonnen",
  "sessions.empty.title": "Noch keine Sitzungen",
  "sessions.empty.body":
    "Eine Sitzung ist ein Besuch einer Person. Beim Anlegen erhält sie den nächsten Platz im Plan.",
  "join.open": "Neue Sitzung",
  "join.title": "Neue Sitzung",
  "join.code": "Code der Person",
  "join.codeTooLong": "Höchstens {{most}} Zeichen",
  "join.codeHint": "Ein Code, nie ein Name. Bleibt das Feld leer, wird einer erzeugt.",
  "join.codePlaceholder": "wird erzeugt",
  "join.language": "Sprache der Person",
  "join.submit": "Sitzung anlegen",
  "simulated.title": "SIMULIERTE DATEN",
  "simulated.body":
    "Diese Zahlen stammen von simulierten Personen. Sie zeigen, dass die Studie funktioniert, nicht, wie Menschen reagieren würden.",
  "simulated.watermark": "SIMULIERT",
  "simulated.session.real": "Simulierte Sitzung, in Echtzeit",
  "simulated.session": "Simulierte Sitzung, höchstens {{scale}} × Echtzeit",
  "protocol.frozen":
    "Diese Version ist eingefroren, weil eine Sitzung begonnen hat. Eine Änderung wird zur neuen Version; vorhandene Sitzungen behalten die Version, mit der sie begonnen haben.",
  "protocol.open":
    "Es hat noch keine Sitzung begonnen. Mit der ersten wird diese Version eingefroren.",
  "protocol.newVersion": "Neue Version",
  "entry.title": "Antworten für {{code}} eingeben",
  "entry.recorded":
    "Es wird festgehalten, dass Sie diese Antworten eingegeben haben. Unbeantwortete Fragen bleiben leer.",
  "entry.none": "Gerade gibt es kein Formular auszufüllen.",
  "form.submit": "Antworten speichern",
};
