/** The participant's texts in German. */
import type { en } from "./en";

export const de: Record<keyof typeof en, string> = {
  "pair.title": "Dieses Tablet verbinden",
  "pair.lead":
    "Geben Sie den Code ein, den der Bildschirm der Versuchsleitung zeigt, oder scannen Sie den QR-Code.",
  "pair.code": "Verbindungscode",
  "pair.delete": "Letztes Zeichen löschen",
  "pair.connect": "Verbinden",
  "pair.connecting": "Verbindung wird hergestellt",
  "pair.ended.title": "Dieses Tablet wurde getrennt",
  "pair.ended.body":
    "Die Versuchsleitung muss es neu verbinden. Was Sie bisher eingegeben haben, bleibt auf diesem Tablet erhalten.",
  "pair.headset": "Dieser Code gehört zu einer VR-Brille.",
  "pair.headsetRemedy": "Bitten Sie die Versuchsleitung um den Code für das Tablet.",
  "error.unreachable": "Das Tablet hat keine Verbindung zum Studienrechner.",
  "error.unreachableRemedy":
    "Bitte sagen Sie der Versuchsleitung Bescheid. Ihre Eingaben gehen nicht verloren.",
  "error.unexpected": "Auf dieser Seite ist etwas schiefgegangen.",
  "error.retry": "Noch einmal versuchen",
  "bar.simulated": "Simulierte Sitzung",
  "bar.offline": "Keine Verbindung. Ihre Antworten bleiben auf diesem Tablet.",
  "bar.language": "Sprache",
  "waiting.title": "Bitte einen Moment warten",
  "waiting.body":
    "Im Augenblick gibt es hier nichts zu tun. Die Versuchsleitung sagt Ihnen, wenn es weitergeht.",
  "waiting.next": "Als Nächstes",
  "consent.title": "Einwilligung",
  "consent.go": "Ich willige ein",
  "instructions.title": "Anleitung",
  "instructions.go": "Ich habe das gelesen",
  "instructions.ask": "Ist etwas unklar?",
  "instructions.askBody":
    "Bitte fragen Sie jetzt die Versuchsleitung. Es ist Zeit, und keine Frage ist zu klein.",
  "reading.more": "Weiterlesen",
  "ask.question": "Ich habe eine Frage",
  "ask.decline": "Ich möchte nicht teilnehmen",
  "ask.question.title": "Bitte fragen Sie",
  "ask.question.body": "Sprechen Sie die Versuchsleitung an. Danach können Sie hier weitermachen.",
  "ask.decline.title": "Das ist in Ordnung",
  "ask.decline.body":
    "Bitte sagen Sie es der Versuchsleitung. Sie müssen keinen Grund nennen und haben keinen Nachteil.",
  "unit.years": "Jahre",
  "form.yes": "Ja",
  "form.no": "Nein",
  "form.optional": "freiwillig",
  "form.required": "Bitte beantworten Sie diese Frage.",
  "form.back": "Zurück",
  "form.next": "Weiter",
  "form.submit": "Antworten senden",
  "form.page": "Seite {{number}} von {{total}}",
  "form.range": "{{low}} bis {{high}} {{unit}}",
  "sending.title": "Ihre Antworten werden gesendet",
  "sending.body": "Einen Moment.",
  "sending.offline": "Ihre Antworten sind sicher",
  "sending.offlineBody":
    "Gerade besteht keine Verbindung. Die Antworten bleiben auf diesem Tablet und werden gesendet, sobald sie wieder da ist. Bitte sagen Sie der Versuchsleitung Bescheid.",
  "held.title": "Diese Antworten sind gerade nicht dran",
  "held.body": "Sie bleiben auf diesem Tablet. Bitte sagen Sie der Versuchsleitung Bescheid.",
  "sent.title": "Danke, Ihre Antworten sind gespeichert",
  "sent.body": "Gleich geht es weiter.",
  "finished.title": "Danke für Ihre Teilnahme",
  "finished.body":
    "Sie sind fertig. Bitte geben Sie das Tablet der Versuchsleitung zurück, die Ihre Fragen gern beantwortet.",
};
