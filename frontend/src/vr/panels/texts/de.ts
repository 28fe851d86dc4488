/** The texts of the panels in the headset, in German. */
import { formDe } from "@shared/forms/texts";
import type { en } from "./en";

export const de: Record<keyof typeof en, string> = {
  ...formDe,
  "form.submit": "Antworten senden",
  "reading.page": "Seite {{page}} von {{pages}}",
  "reading.done": "Ich habe das gelesen",
  "reading.ask": "Ich habe eine Frage",
  "reading.asked.title": "Die Versuchsleitung wurde gerufen",
  "reading.asked.body": "Bitte stellen Sie Ihre Frage laut. Danach können Sie hier weitermachen.",
  "reading.continue": "Weiter",
  "form.start": "Beginnen",
  "form.intro_one": "Es gibt eine Frage.",
  "form.intro_other":
    "Es gibt {{count}} Fragen, eine nach der anderen. Sie können jederzeit zurückgehen.",
  "form.how":
    "Zeigen Sie auf eine Antwort. Drücken Sie den Abzug oder tippen Sie Daumen und Zeigefinger zusammen.",
  "form.question": "Frage {{number}} von {{total}}",
  "form.review": "Antworten prüfen",
  "form.review.title": "Ihre Antworten",
  "form.review.body": "Zeigen Sie auf eine Frage, um ihre Antwort zu ändern.",
  "form.review.page": "{{page}} von {{pages}}",
  "form.review.more": "Mehr",
  "form.spoken": "Ich sage es der Versuchsleitung",
  "form.nothing": "Nichts zu sagen",
  "form.spoken.lead":
    "Hier können Sie nicht schreiben. Sagen Sie Ihre Antwort der Versuchsleitung; sie schreibt sie auf.",
  "form.unanswered": "nicht beantwortet",
  "form.tooLong":
    "Das ist zu lang für das Headset. Bitte sagen Sie der Versuchsleitung Bescheid; sie fragt es mündlich.",
  "form.delete": "Löschen",
  "sending.title": "Ihre Antworten werden gesendet",
  "sending.body": "Einen Moment.",
  "sending.offline": "Ihre Antworten sind sicher",
  "sending.offlineBody":
    "Im Moment gibt es keine Verbindung. Ihre Antworten bleiben in diesem Headset und werden gesendet, sobald die Verbindung wieder da ist. Bitte sagen Sie der Versuchsleitung Bescheid.",
  "sending.retry": "Noch einmal versuchen",
  "refused.title": "Etwas muss berichtigt werden",
  "refused.body":
    "Der Server konnte diese Antworten nicht annehmen. Bitte prüfen Sie sie noch einmal.",
  "held.title": "Diese Antworten werden jetzt nicht gebraucht",
  "held.body": "Sie bleiben in diesem Headset. Bitte sagen Sie der Versuchsleitung Bescheid.",
  "sent.title": "Danke, Ihre Antworten sind gespeichert",
  "sent.body": "Es geht gleich weiter.",
  "waiting.title": "Bitte warten Sie einen Moment",
  "waiting.body":
    "Hier gibt es gerade nichts zu tun. Die Versuchsleitung sagt Ihnen, wann es weitergeht.",
  "standby.title": "Bereit",
  "standby.body":
    "Sie sind verbunden. Sehen Sie sich in Ruhe um. Die Versuchsleitung beginnt, wenn Sie bereit sind.",
  "standby.stop":
    "Sie können jederzeit anhalten: Halten Sie eine Sekunde lang eine Hand über den Kopf, oder drücken Sie so lange beide Greiftasten.",
  "standby.stopHands":
    "Sie können jederzeit anhalten: Halten Sie eine Sekunde lang eine Hand über den Kopf.",
  "pairing.title": "Dieses Headset verbinden",
  "pairing.body":
    "Nehmen Sie das Headset kurz ab und geben Sie den Code ein, den die Versuchsleitung zeigt.",
  "offline.title": "Keine Verbindung",
  "offline.body":
    "Die Verbindung zum Studienrechner ist unterbrochen. Es geht nichts verloren. Bitte warten Sie; die Versuchsleitung weiß Bescheid.",
  "takeOff.title": "Bitte nehmen Sie das Headset ab",
  "takeOff.body":
    "Der nächste Teil findet nicht im Headset statt. Bleiben Sie stehen, schließen Sie kurz die Augen und heben Sie das Headset ab. Die Versuchsleitung ist bei Ihnen.",
  "takeOff.told": "Die Versuchsleitung weiß Bescheid.",
  "takeOff.form":
    "Die nächsten Fragen stehen auf dem Tablet. Bleiben Sie stehen, schließen Sie kurz die Augen und heben Sie das Headset ab.",
  "finished.title": "Das war alles, vielen Dank",
  "finished.body": "Sie können das Headset jetzt abnehmen. Die Versuchsleitung hilft Ihnen.",
  "stop.hold": "Halten für Stopp",
  "stop.cancel": "Hand senken, um weiterzumachen",
  "stop.cancelGrips": "Loslassen, um weiterzumachen",
  "pause.title": "Sie haben angehalten",
  "pause.body":
    "Die Versuchsleitung weiß Bescheid und kommt zu Ihnen. Atmen Sie ruhig, sehen Sie sich um oder nehmen Sie das Headset ab. Es passiert nichts, bis Sie weitermachen möchten.",
  "pause.telling": "Die Versuchsleitung wird benachrichtigt.",
  "pause.untold": "Die Versuchsleitung konnte nicht benachrichtigt werden. Bitte rufen Sie laut.",
  "pause.operator.title": "Eine kurze Pause",
  "pause.operator.body": "Die Sitzung ist angehalten. Sie müssen nichts tun.",
  "pause.resume": "Es geht weiter, wenn die Versuchsleitung fortfährt.",
  "comfort.title": "Wie geht es Ihnen?",
  "comfort.body":
    "Wenn Ihnen schwindelig oder unwohl ist, sagen Sie es oder halten Sie an. Das hat für Sie keine Nachteile.",
  decimal: ",",
  "boundary.area": "Ihr Spielbereich",
  "boundary.title": "Nahe am Rand",
  "boundary.body": "Bitte gehen Sie zurück in die Mitte des Raums.",
  "boundary.missing":
    "In diesem Headset ist kein Spielbereich eingerichtet. Bitten Sie die Versuchsleitung, einen einzurichten, bevor Sie sich bewegen.",
  "boundary.small":
    "Der Spielbereich ist kleiner, als diese Studie ihn braucht: {{haveM}} mal {{haveDepthM}} m statt {{needM}} mal {{needDepthM}} m. Bitte sagen Sie der Versuchsleitung Bescheid.",
  "steppingIn.title": "Treten Sie in die Figur hinein",
  "steppingIn.body":
    "Stellen Sie sich in die durchsichtige Figur und strecken Sie die Arme so aus wie sie. Drücken Sie dann beide Greiftasten.",
  "steppingIn.bodyHands":
    "Stellen Sie sich in die durchsichtige Figur und strecken Sie die Arme so aus wie sie. Machen Sie dann zwei Fäuste.",
  "steppingIn.keys":
    "Auf diesem Bildschirm: Die Leertaste drückt beide Griffe, T streckt die Arme aus.",
  "ready.body": "Die Versuchsleitung beginnt, sobald Sie bereit sind.",
  "toStart.body":
    "Stellen Sie sich auf das weiße Quadrat; lassen Sie sich dorthin führen. Es beginnt, sobald der Verkehr läuft.",
  "toStart.keys":
    "Auf diesem Bildschirm: Gehen Sie mit S rückwärts, bis Sie auf dem weißen Quadrat stehen; A und D gehen zur Seite, W vorwärts.",
  "preparing.countdown": "Beginnt in {{seconds}} s",
  "preparing.traffic": "Beginnt, sobald der Verkehr läuft",
  "aloud.title": "Bitte antworten Sie mündlich",
  "aloud.body":
    "Die Versuchsleitung stellt Ihnen die Fragen und schreibt auf, was Sie sagen. Sie können das Headset aufbehalten.",
  "lookAround.title": "Bitte sehen Sie sich um",
  "lookAround.body":
    "Drehen Sie den Kopf langsam nach links und rechts, sehen Sie dann nach oben und unten, bis dieses Schild verschwindet. So werden Ihre Tracker gefunden.",
  "feet.body":
    "Diese Aufgabe kann nicht beginnen: Ihre Füße werden gerade nicht gemessen. Die Versuchsleitung weiß Bescheid.",
  "elsewhere.title": "Bitte sehen Sie auf das Tablet",
  "elsewhere.form": "Die nächsten Fragen stehen auf dem Tablet. Danach geht es hier weiter.",
  "elsewhere.body": "Der nächste Teil ist auf dem Tablet. Danach geht es hier weiter.",
  "boundary.goOn": "So weitermachen",
  "form.loading": "Ihre Fragen werden geholt",
  "calibration.step": "Schritt {{number}} von {{total}}",
  "calibration.square.title": "Bleiben Sie auf dem Quadrat stehen",
  "calibration.square.body":
    "Sehen Sie geradeaus. Ist dieser Text unscharf? Dann schieben Sie das Headset nach oben oder unten, bis er scharf ist.",
  "calibration.n_pose.title": "Stehen Sie aufrecht, Arme unten",
  "calibration.n_pose.body":
    "Stehen Sie gerade, die Füße nebeneinander. Lassen Sie beide Arme hängen. Sehen Sie geradeaus und bleiben Sie 2 Sekunden still.",
  "calibration.t_pose.title": "Strecken Sie die Arme zur Seite",
  "calibration.t_pose.body":
    "Beide Arme gestreckt, in Höhe der Schultern, Handflächen nach unten. Bleiben Sie 2 Sekunden still.",
  "calibration.measuring": "Bleiben Sie so: {{seconds}}",
  "calibration.squat.title": "In die Knie gehen und wieder hoch",
  "calibration.squat.body":
    "Beugen Sie die Knie ein wenig, als wollten Sie sich setzen. Richten Sie sich wieder auf und bleiben Sie ruhig stehen.",
  "calibration.reach.title": "Nach vorn greifen",
  "calibration.reach.body": "Strecken Sie beide Hände nach vorn aus, so hoch wie die Schultern.",
  "calibration.mirror.title": "Sehen Sie in den Spiegel",
  "calibration.mirror.body":
    "Bewegen Sie langsam Arme und Beine. Bewegt sich die Figur so wie Sie? Wenn Sie nichts drücken, geht es von selbst weiter.",
  "calibration.mirror.good": "Sie bewegt sich wie ich",
  "calibration.mirror.bad": "Etwas stimmt nicht",
  "calibration.again": "Bitte noch einmal:",
  "calibration.seconds": "{{seconds}} s",
  "calibration.skip": "Das auslassen",
  "problem.off_square.forward": "Bitte gehen Sie {{distanceCm}} cm nach vorn.",
  "problem.off_square.back": "Bitte gehen Sie {{distanceCm}} cm zurück.",
  "problem.off_square.left": "Bitte gehen Sie {{distanceCm}} cm nach links.",
  "problem.off_square.right": "Bitte gehen Sie {{distanceCm}} cm nach rechts.",
  "problem.turned.left": "Bitte drehen Sie sich nach links, zum Spiegel.",
  "problem.turned.right": "Bitte drehen Sie sich nach rechts, zum Spiegel.",
  "problem.looking": "Bitte sehen Sie geradeaus.",
  "problem.bent_knees": "Ihre Knie sind gebeugt. Bitte stehen Sie gerade.",
  "problem.bent_elbows": "Bitte strecken Sie die Arme.",
  "problem.arms_not_down": "Bitte lassen Sie beide Arme hängen.",
  "problem.arms_not_level": "Bitte heben Sie beide Arme bis zur Höhe der Schultern.",
  "problem.arm_too_high": "Bitte senken Sie die Arme ein wenig.",
  "problem.feet_apart": "Bitte stellen Sie die Füße nebeneinander.",
  "problem.swapped_hands":
    "Linke und rechte Hand sind vertauscht. Bitte nehmen Sie die Controller in die jeweils andere Hand.",
  "problem.swapped_shins":
    "Die Tracker am linken und am rechten Bein sind vertauscht. Bitte sagen Sie der Versuchsleitung Bescheid.",
  "problem.moving": "Bitte halten Sie still.",
  "problem.lost":
    "Gerade nicht zu sehen: {{part}}. Bitte bewegen Sie sich so, dass das Headset freie Sicht hat.",
  "problem.not_bent": "Bitte gehen Sie etwas tiefer in die Knie.",
  "problem.not_reached": "Bitte strecken Sie die Hände weiter nach vorn.",
  "problem.palms_not_down": "Bitte drehen Sie die Handflächen zum Boden.",
  "problem.not_upright": "Bitte richten Sie sich wieder ganz auf.",
  "problem.goal_error": "{{part}}: {{errorCm}} cm neben der richtigen Stelle.",
  "problem.implausible":
    "Das ergibt eine Größe von {{valueCm}} cm. Bitte stehen Sie aufrecht, oder sagen Sie der Versuchsleitung, dass der Boden des Headsets nicht stimmt.",
  "part.Head": "Kopf",
  "part.Hips": "Hüfte",
  "part.LeftHand": "linke Hand",
  "part.RightHand": "rechte Hand",
  "part.LeftLowerLeg": "linker Unterschenkel",
  "part.RightLowerLeg": "rechter Unterschenkel",
};
