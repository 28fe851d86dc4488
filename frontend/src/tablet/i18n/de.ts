/** The participant's texts in German. */

import { formDe } from "@shared/forms/texts";
import { proseDe } from "@shared/prose/texts";
import { pageDe } from "@shared/ui/pageTexts";
import type { en } from "./en";

export const de: Record<keyof typeof en, string> = {
  ...pageDe,
  ...formDe,
  ...proseDe,
  "pair.title": "Dieses Tablet verbinden",
  "pair.lead":
    "Geben Sie den Code ein, der auf dem Bildschirm der Versuchsleitung steht. Steht ein QR-Code daneben, können Sie stattdessen ihn scannen.",
  "pair.code": "Verbindungscode",
  "pair.delete": "Letztes Zeichen löschen",
  "pair.connecting": "Verbindung wird hergestellt",
  "pair.ended.title": "Dieses Tablet wurde getrennt",
  "pair.ended.body":
    "Die Versuchsleitung muss es neu verbinden. Was Sie bisher eingegeben haben, bleibt auf diesem Tablet erhalten.",
  "pair.headset": "Dieser Code gehört zu einem Headset.",
  "pair.headsetRemedy": "Bitten Sie die Versuchsleitung um den Code für das Tablet.",
  "error.unreachable": "Das Tablet hat keine Verbindung zum Studienrechner.",
  "error.unreachableRemedy":
    "Bitte sagen Sie der Versuchsleitung Bescheid. Ihre Eingaben gehen nicht verloren.",
  "error.unexpected": "Auf dieser Seite ist etwas schiefgegangen.",
  "error.retry": "Noch einmal versuchen",
  "bar.simulated": "Simulierte Sitzung",
  "bar.offline": "Keine Verbindung. Ihre Antworten bleiben auf diesem Tablet.",
  "bar.language": "Sprache",
  "bar.textSize": "Schriftgröße: {{percent}} %. Drücken, um sie zu ändern",
  "help.call": "Versuchsleitung rufen",
  "help.called": "Die Versuchsleitung wurde gerufen",
  "help.takeBack": "Nicht mehr nötig",
  "help.failed": "Der Ruf kann gerade nicht gesendet werden. Bitte sprechen Sie uns an.",
  "waiting.title": "Bitte einen Moment warten",
  "waiting.body":
    "Im Augenblick gibt es hier nichts zu tun. Die Versuchsleitung sagt Ihnen, wenn es weitergeht.",
  "elsewhere.in_headset":
    "Die Fragen stehen im Headset. Bitte setzen Sie es auf oder lassen Sie es auf.",
  "elsewhere.oral": "Die Versuchsleitung stellt Ihnen die Fragen. Bitte antworten Sie mündlich.",
  "waiting.next": "Als Nächstes",
  "consent.title": "Einwilligung",
  "consent.go": "Ich willige ein",
  "consent.statements": "Bitte kreuzen Sie an, womit Sie einverstanden sind",
  "consent.signature": "Ihre Unterschrift",
  "consent.surface": "Fläche zum Unterschreiben mit Finger, Stift oder Maus",
  "consent.clear": "Löschen",
  "consent.type": "Stattdessen meinen Namen tippen",
  "consent.draw": "Stattdessen unterschreiben",
  "consent.name": "Vor- und Nachname",
  "consent.missing.statements": "Bitte kreuzen Sie alle Aussagen an, die nicht freiwillig sind.",
  "consent.missing.name": "Bitte geben Sie Ihren Namen ein.",
  "consent.missing.signature": "Bitte unterschreiben Sie auf der Fläche oben.",
  "held.wait.title": "Bitte warten, die Versuchsleitung kommt",
  "held.wait.body":
    "Sie haben nichts falsch gemacht. Wenn Sie möchten, können Sie das Headset abnehmen und sich setzen.",
  "instructions.title": "Anleitung",
  "instructions.go": "Ich habe das gelesen",
  "instructions.ask": "Ist etwas unklar?",
  "instructions.askBody":
    "Bitte fragen Sie jetzt die Versuchsleitung. Es ist genug Zeit, und keine Frage ist zu klein.",
  "reading.more": "Weiterlesen",
  "ask.question": "Ich habe eine Frage",
  "ask.decline": "Ich möchte nicht teilnehmen",
  "ask.question.title": "Die Versuchsleitung wurde gerufen",
  "ask.question.body": "Bitte stellen Sie Ihre Frage. Danach können Sie hier weitermachen.",
  "refused.title": "Das ist in Ordnung",
  "refused.told":
    "Die Versuchsleitung weiß, dass Sie nicht teilnehmen möchten, und kommt zu Ihnen.",
  "refused.telling": "Die Versuchsleitung wird benachrichtigt.",
  "refused.untold":
    "Dieses Tablet erreicht die Versuchsleitung gerade nicht. Bitte sagen Sie der Versuchsleitung, dass Sie nicht teilnehmen möchten.",
  "refused.free": "Sie müssen keinen Grund nennen, und Ihnen entsteht kein Nachteil.",
  "refused.takeBack": "Ich habe es mir anders überlegt",
  "form.submit": "Antworten senden",
  "sending.title": "Ihre Antworten werden gesendet",
  "sending.body": "Einen Moment.",
  "sending.offline": "Ihre Antworten sind sicher",
  "sending.offlineBody":
    "Gerade besteht keine Verbindung. Ihre Antworten bleiben auf diesem Tablet und werden gesendet, sobald die Verbindung wieder da ist. Bitte sagen Sie der Versuchsleitung Bescheid.",
  "held.title": "Diese Antworten werden gerade nicht gebraucht",
  "held.body": "Sie bleiben auf diesem Tablet. Bitte sagen Sie der Versuchsleitung Bescheid.",
  "sent.title": "Danke, Ihre Antworten sind gespeichert",
  "sent.body": "Gleich geht es weiter.",
  "finished.refused.title": "Danke für Ihre Zeit",
  "finished.refused.body":
    "Sie haben nicht teilgenommen. Bitte geben Sie das Tablet der Versuchsleitung zurück, die Ihre Fragen gern beantwortet.",
  "finished.title": "Danke für Ihre Teilnahme",
  "finished.body":
    "Sie sind fertig. Bitte geben Sie das Tablet der Versuchsleitung zurück, die Ihre Fragen gern beantwortet.",
};
