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
};
