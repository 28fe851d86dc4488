/** The console's texts in German. */
import type { en } from "./en";

export const de: Record<keyof typeof en, string> = {
  "app.name": "Reembody",
  "app.studies": "Studien",
  "app.logout": "Abmelden",
  "app.signedInAs": "Angemeldet als {{name}} ({{role}})",
  "app.account": "Konto",
  "app.theme.dark": "Dunkle Darstellung",
  "app.theme.light": "Helle Darstellung",
  "app.language": "English",
  "app.skip": "Zum Inhalt springen",
  "error.unreachable": "Der Server antwortet nicht.",
  "error.unreachableRemedy":
    "Prüfen Sie, ob er läuft und ob dieser Rechner in seinem Netz ist. Auf dem Server ist nichts verloren.",
  "error.unexpected": "Auf dieser Seite ist etwas schiefgegangen.",
  "error.retry": "Noch einmal versuchen",
  "login.title": "Anmelden",
  "login.lead": "Studien zur Verkörperung in VR durchführen, beobachten und auswerten.",
  "login.username": "Benutzername",
  "login.password": "Passwort",
  "login.submit": "Anmelden",
  "login.hint":
    "Das erste Konto heißt admin. Sein Passwort wurde beim ersten Start des Servers einmal ausgegeben.",
};
