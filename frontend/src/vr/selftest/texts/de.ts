import { verdictsDe } from "@shared/selfTest/texts";
import type { selfTestEn } from "./en";

/** The texts of the self-test in German. */
export const selfTestDe: Record<keyof typeof selfTestEn, string> = {
  ...verdictsDe,
  "selftest.button": "Diese VR-Brille testen (2 Minuten)",
  "selftest.buttonOnScreen": "Diesen Rechner auf dem Bildschirm testen (2 Minuten)",
  "selftest.what":
    "Misst Bildrate, Physik, Tracking und Speicherung auf diesem Gerät. Nichts davon gehört zu einer Sitzung.",
  "selftest.title": "Test dieser VR-Brille",
  "selftest.stop": "Test beenden",
  "selftest.heldBack":
    "Nicht, während die Sitzung läuft: Der Test geht wieder, bevor der Körper betreten wird und nach dem Ende.",
  "selftest.awaited.body":
    "Der Körper und seine Physik werden erwartet: {{waited}} von höchstens {{most}} s.",
  "selftest.awaited.sending":
    "Der Speicher des Servers wird erwartet: {{waited}} von höchstens {{most}} s.",
  "selftest.awaited.picture":
    "Das erste Bild des Körpers wird erwartet: {{waited}} von höchstens {{most}} s.",
  "selftest.unseen.title": "Dieses Gerät hat keine Bilder gezeichnet",
  "selftest.unseen.body":
    "In der Zeit eines ganzen Tests gab es zu wenige Bilder, um etwas zu messen. Holen Sie diese Seite nach vorn, schließen Sie andere Programme und Tabs und schalten Sie in den Einstellungen des Browsers die Grafikbeschleunigung ein. Testen Sie dann erneut.",
  "selftest.preparing.title": "Der Test wird vorbereitet",
  "selftest.preparing.body": "Raum und Körper werden geladen. Das dauert einige Sekunden.",
  "selftest.step": "Test, Teil {{number}} von {{total}}",
  "selftest.look.title": "Sehen Sie sich um",
  "selftest.look.body":
    "Drehen Sie den Kopf langsam nach links und rechts, nach oben und unten. Sehen Sie dann über Ihre Schultern.",
  "selftest.hands.title": "Bewegen Sie beide Hände vor sich",
  "selftest.hands.body":
    "Greifen Sie nach vorn, nach oben und zur Seite, als berührten Sie Boxen in Armlänge. Die Hände bleiben im Blick.",
  "selftest.step.title": "Treten Sie auf der Stelle",
  "selftest.step.body":
    "Heben Sie abwechselnd die Knie, und setzen Sie die Füße nach vorn, nach hinten und zur Seite.",
  "selftest.free.title": "Bewegen Sie sich, wie Sie möchten",
  "selftest.free.body":
    "Sehen Sie Ihren Körper im Spiegel an und bewegen Sie alles: in die Hocke gehen, winken, umdrehen.",
  "selftest.scripted":
    "Im Moment wird niemand getrackt: Ein Skript bewegt den Körper, und der Bericht sagt das.",
  "selftest.left": "noch {{time}}",
  "selftest.sending.title": "Der Bericht wird gespeichert",
  "selftest.sending.body": "Einen Moment.",
  "selftest.kept.title": "Der Bericht ist auf diesem Gerät sicher",
  "selftest.kept.body":
    "Der Studienrechner antwortet nicht. Der Bericht bleibt hier und wird gesendet, sobald er wieder da ist; Sie müssen nicht darauf warten.",
  "selftest.ok.title": "Alles in Ordnung",
  "selftest.warn.title": "Verwendbar, mit einem Hinweis",
  "selftest.fail.title": "Das ist vor einer Studie zu klären",
  "selftest.count": "{{ok}} von {{total}} Werten sind in Ordnung.",
  "selftest.more_one": "und ein weiterer auf der Seite",
  "selftest.more_other": "und {{count}} weitere auf der Seite",
  "selftest.notWorn":
    "Niemand hat die VR-Brille getragen: Das zeigt, dass die Seite funktioniert, nicht wie gut das Gerät ist.",
  "selftest.stored": "Der Bericht ist gespeichert.",
  "selftest.where": "Auf dem Studienrechner: Geräte > Headset-Tests.",
  "selftest.leave": "VR verlassen",
  "selftest.again": "Noch einmal testen",
  "selftest.back": "Zurück",
  "selftest.short.title": "Vorzeitig beendet",
  "selftest.short.body":
    "Es wurden weniger als {{seconds}} s gemessen. Das sagt nichts über das Gerät, deshalb wurde nichts gespeichert.",
  "selftest.visit.title": "Der Test ist beendet, weil die Sitzung weitergeht",
  "selftest.visit.body":
    "Betreten Sie VR für die Sitzung. Testen Sie die VR-Brille davor oder danach.",
  "selftest.failed.title": "Der Test konnte nicht beginnen",
  "selftest.waiting_one":
    "Ein Bericht eines Tests wartet auf diesem Gerät darauf, gespeichert zu werden.",
  "selftest.waiting_other":
    "{{count}} Berichte von Tests warten auf diesem Gerät darauf, gespeichert zu werden.",
  "selftest.refused_one":
    "Der Studienrechner nimmt diesen Bericht nicht an, auch später nicht. Testen Sie die VR-Brille noch einmal.",
  "selftest.refused_other":
    "Der Studienrechner nimmt {{count}} Berichte nicht an, auch später nicht. Testen Sie die VR-Brille noch einmal.",
  "selftest.discard_one": "Bericht von diesem Gerät löschen",
  "selftest.discard_other": "{{count}} Berichte von diesem Gerät löschen",
  "selftest.retry": "Jetzt senden",
  "selftest.summary": "{{device}}, {{frames}} Bilder in {{duration}}, bewegt durch: {{inputs}}",
};
