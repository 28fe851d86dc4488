import { pageDe } from "@shared/ui/pageTexts";
import { selfTestDe } from "../selftest/texts/de";
import type { en } from "./en";

/** The texts of the headset's page in German. */
export const de: Readonly<Record<keyof typeof en, string>> = {
  ...pageDe,
  ...selfTestDe,
  "enter.title": "An der Studie teilnehmen",
  "enter.lead":
    "Setzen Sie die VR-Brille auf und achten Sie darauf, dass das Bild scharf ist. Drücken Sie dann auf den Knopf.",
  "enter.button": "VR starten",
  "enter.name": "Name dieses Geräts",
  "enter.name.hint":
    "Etwa „Quest 3, Raum 2“. Dieser Browser behält ihn; er steht bei Tests und bei der nächsten Kopplung.",
  "enter.onScreen": "Auf diesem Bildschirm handeln",
  "enter.again": "Zurück in die VR",
  "enter.language": "Sprache",
  "enter.simulated": "Simulierte Sitzung",
  "enter.connecting": "Verbindung zum Studienrechner wird hergestellt",
  "enter.offline":
    "Die Verbindung ist unterbrochen und wird wiederhergestellt. Alles bisher Aufgezeichnete bleibt auf dieser VR-Brille erhalten.",
  "enter.over": "Die Sitzung ist beendet",
  "enter.overBody": "Sie können die VR-Brille abnehmen. Vielen Dank für Ihre Teilnahme.",
  "enter.next": "Für die nächste Sitzung geben Sie deren Code ein.",
  "enter.failed": "VR konnte nicht gestartet werden",
  "enter.stopped": "Diese VR-Brille hat angehalten",
  "enter.withdrawn":
    "Die Teilnahme wurde beendet. Was diese VR-Brille noch von der Sitzung hatte, wurde gelöscht.",
  "enter.inUse": "Diese Studie ist in einem anderen Tab offen",
  "enter.inUse.remedy": "Schließen Sie den anderen Tab und laden Sie diese Seite neu.",
  "enter.takenOver": "Eine andere Seite dieser VR-Brille setzt die Sitzung fort",
  "enter.takenOver.remedy":
    "Machen Sie dort weiter. Um hier weiterzumachen, laden Sie diese Seite neu.",
  "enter.foreign": "Dieses Headset hat noch Aufzeichnungen einer anderen Sitzung",
  "enter.foreign.remedy":
    "Sie sind noch nicht beim Studienrechner. Koppeln Sie das Headset zuerst wieder mit jener Sitzung: Sie werden gesendet, sobald es verbunden ist. Verwenden Sie danach den Code dieser Sitzung.",
  "enter.ended": "VR wurde geschlossen. Die Sitzung wartet, bis Sie zurückkehren.",
  "enter.disconnect": "Anderen Code verwenden",
  "pair.title": "Diese VR-Brille verbinden",
  "pair.lead": "Geben Sie den Code ein, den der Bildschirm der Versuchsleitung zeigt.",
  "pair.code": "Verbindungscode",
  "pair.delete": "Letztes Zeichen löschen",
  "pair.connecting": "Wird verbunden",
  "pair.ended.title": "Diese VR-Brille wurde getrennt",
  "pair.ended.body":
    "Die Versuchsleitung muss sie neu verbinden. Was bisher aufgezeichnet wurde, bleibt auf dieser VR-Brille erhalten.",
  "pair.tablet": "Dieser Code gehört zu einem Tablet.",
  "pair.tabletRemedy": "Fragen Sie die Versuchsleitung nach dem Code der VR-Brille.",
  "error.unreachable": "Die VR-Brille hat keine Verbindung zum Studienrechner.",
  "error.unreachableRemedy":
    "Prüfen Sie das WLAN der VR-Brille und versuchen Sie es dann noch einmal.",
  "error.unexpected": "Auf dieser Seite ist etwas schiefgegangen.",
  "error.retry": "Noch einmal versuchen",
  "support.insecure": "VR braucht eine sichere Verbindung",
  "support.insecure.quest":
    "Verbinden Sie die VR-Brille per USB-Kabel mit dem Rechner, führen Sie dort „adb reverse tcp:8321 tcp:8321“ aus und öffnen Sie hier http://localhost:8321/vr. Oder öffnen Sie die https-Adresse von der Seite „Netzwerk“ der Konsole und bestätigen Sie einmal die Warnung des Browsers.",
  "support.insecure.pico":
    "Öffnen Sie die https-Adresse von der Seite „Netzwerk“ der Konsole und bestätigen Sie einmal die Warnung des Browsers. Ein USB-Kabel geht auch: Führen Sie auf dem Rechner „adb reverse tcp:8321 tcp:8321“ aus und öffnen Sie hier http://localhost:8321/vr.",
  "support.insecure.vision_pro":
    "Öffnen Sie die https-Adresse von der Seite „Netzwerk“ der Konsole. Installieren Sie vorher das Zertifikat des Labors von der Hilfeseite: Ohne dieses lehnt Safari Live-Verbindungen ab.",
  "support.insecure.android_xr":
    "Öffnen Sie die https-Adresse von der Seite „Netzwerk“ der Konsole. Installieren Sie vorher das Zertifikat des Labors in den Einstellungen, oder bestätigen Sie einmal die Warnung des Browsers.",
  "support.insecure.computer":
    "Öffnen Sie diese Seite auf dem Studienrechner als http://localhost:8321/vr, oder unter der https-Adresse von der Seite „Netzwerk“ der Konsole.",
  "support.no_webxr": "Dieser Browser kann keine VR zeigen",
  "support.no_webxr.quest":
    "Aktualisieren Sie den Browser der VR-Brille: Nötig ist der Meta Quest Browser ab Version 15.",
  "support.no_webxr.pico":
    "Aktualisieren Sie den Browser der VR-Brille: Nötig ist der PICO Browser ab Version 4.",
  "support.no_webxr.vision_pro":
    "Aktualisieren Sie auf visionOS 2 oder neuer. Unter visionOS 1 schalten Sie WebXR ein: Einstellungen > Apps > Safari > Erweitert > Feature-Flags.",
  "support.no_webxr.android_xr": "Öffnen Sie diese Seite in Chrome und aktualisieren Sie es.",
  "support.no_webxr.computer":
    "Öffnen Sie diese Seite im Browser der VR-Brille, oder in Chrome oder Edge auf einem Rechner mit VR-Brille. Um die Studie ohne VR-Brille auszuprobieren, koppeln Sie diese Seite und wählen Sie „Auf diesem Bildschirm handeln“.",
  "support.no_headset": "Es wurde keine VR-Brille gefunden",
  "support.no_headset.quest":
    "Starten Sie den Browser der VR-Brille neu und öffnen Sie diese Seite noch einmal.",
  "support.no_headset.pico":
    "Starten Sie den Browser der VR-Brille neu und öffnen Sie diese Seite noch einmal.",
  "support.no_headset.vision_pro": "Starten Sie Safari neu und öffnen Sie diese Seite noch einmal.",
  "support.no_headset.android_xr": "Starten Sie Chrome neu und öffnen Sie diese Seite noch einmal.",
  "support.no_headset.computer":
    "Starten Sie SteamVR oder das Programm der VR-Brille und schalten Sie die Brille ein. Diese Seite bemerkt es von selbst. Um die Studie ohne VR-Brille auszuprobieren, koppeln Sie diese Seite und wählen Sie „Auf diesem Bildschirm handeln“.",
  "operator.title": "Was die Versuchsleitung drückt",
  "operator.next": "Der nächste Schritt der Versuchsleitung:",
  "operator.runs": "Die Aufgabe läuft.",
  "operator.elsewhere":
    "Der nächste Teil ist nicht auf dieser Seite, sondern in der Konsole oder auf dem Tablet.",
  "operator.enter": "Enter",
  "operator.console": "Konsole öffnen",
  "operator.stale": "Die Sitzung war inzwischen weiter. Dies ist nun ihr nächster Schritt.",
  "operator.waits": "Es geht weiter, wenn die Versuchsleitung in der Konsole fortfährt.",
  "operator.signIn": "Sind Sie die Versuchsleitung? Melden Sie sich an, um von hier fortzufahren",
  "desktop.title": "Desktop-Modus",
  "desktop.starting": "Die Studie wird auf diesem Bildschirm vorbereitet",
  "desktop.begin":
    "Klicken Sie in das Bild, um sich mit der Maus umzusehen. Esc gibt sie wieder frei.",
  "desktop.hit":
    "Eine Box treffen: Sehen Sie sie an, halten Sie die rechte Maustaste und drehen Sie das Mausrad, bis die Hand sie berührt. Eine Box für den Fuß: Sehen Sie sie an und drücken Sie Q oder E.",
  "desktop.slow.title": "Dieses Gerät zeichnet nur {{rate}} Bilder in der Sekunde.",
  "desktop.slow.body":
    "Die Uhr der Sitzung steht still, bis es mindestens {{least}} sind. Schließen Sie andere Programme und Tabs, verkleinern Sie dieses Fenster, schalten Sie in den Einstellungen des Browsers die Grafikbeschleunigung ein oder nehmen Sie einen schnelleren Rechner.",
  "desktop.mouse": "Maus",
  "desktop.look": "umsehen",
  "desktop.rightButton": "Rechte Taste",
  "desktop.reach": "dorthin greifen, wohin Sie sehen",
  "desktop.wheel": "Mausrad",
  "desktop.depth": "näher oder weiter greifen",
  "desktop.leftButton": "Linke Taste",
  "desktop.select": "auswählen",
  "desktop.walk": "gehen",
  "desktop.feet": "mit dem linken oder rechten Fuß dorthin treten",
  "desktop.grips": "beide Griffe drücken: in den Körper treten",
  "desktop.hand": "die andere Hand benutzen",
  "desktop.squat": "in die Hocke gehen",
  "desktop.tPose": "T-Pose",
  "desktop.help": "diese Hilfe zeigen oder ausblenden",
  "desktop.space": "Leertaste",
};
