"""The registry of alarms: the severity, title and remedy of each.

To add an alarm, add an entry to `ALARMS` and raise the alarm where it is detected, usually in one
of the modules in `watches`. The cockpit's texts in both languages are generated from
the entry.
"""

from dataclasses import dataclass
from typing import Literal

from app.texts import Words

Severity = Literal["info", "warning", "critical"]


@dataclass(frozen=True)
class AlarmKind:
    """One kind of alarm.

    Attributes:
        key: stored with every alarm, so it is never renamed.
        severity: critical if data are being lost, a phase is halted, or the participant is unwell,
            calls the operator or does not want to take part.
        title: what is wrong, in a few words.
        remedy: what the operator should do about it.
        remedy_while_paused: the same, for when the alarm has paused the phase.
        of_person: whether the alarm is about the participant. Such an alarm stays open until a
            person or a form clears it, even if the server or the headset restarts.
    """

    key: str
    severity: Severity
    title: Words
    remedy: Words
    remedy_while_paused: Words | None = None
    of_person: bool = False


# `impossible` is raised when only the connection can tell that a headset's message cannot be true;
# `doubtful` when the record of a phase that has ended contains something that cannot be true.
# `low_disk` is raised by the pages.
ALARMS: tuple[AlarmKind, ...] = (
    AlarmKind(
        key="silent",
        severity="critical",
        title=Words(en="Headset not responding", de="Headset meldet sich nicht"),
        remedy=Words(
            en="Wake the headset, or check that it is worn.",
            de="Wecken Sie das Headset auf oder prüfen Sie, ob es getragen wird.",
        ),
        remedy_while_paused=Words(
            en="The phase is paused. Wake the headset, then press Resume.",
            de="Die Phase ist angehalten. Wecken Sie das Headset auf und drücken Sie dann "
            "Fortsetzen.",
        ),
    ),
    AlarmKind(
        key="page_silent",
        severity="critical",
        title=Words(
            en="Participant's page not responding", de="Seite der Person meldet sich nicht"
        ),
        remedy=Words(
            en="Bring the page /vr to the front on its computer: in the background it draws "
            "nothing.",
            de="Holen Sie die Seite /vr auf ihrem Rechner nach vorn: Im Hintergrund zeichnet sie "
            "nichts.",
        ),
        remedy_while_paused=Words(
            en="The phase is paused. Bring the page /vr to the front, then press Resume.",
            de="Die Phase ist angehalten. Holen Sie die Seite /vr nach vorn und drücken Sie dann "
            "Fortsetzen.",
        ),
    ),
    AlarmKind(
        key="too_slow",
        severity="critical",
        title=Words(
            en="Device draws fewer than 2 pictures a second",
            de="Gerät zeichnet weniger als 2 Bilder in der Sekunde",
        ),
        remedy=Words(
            en="Its clock stands still until there are 2. Close other programs, turn on the "
            "browser's graphics acceleration, or use a faster device.",
            de="Bis es 2 sind, steht die Uhr still. Schließen Sie andere Programme, schalten Sie "
            "die Grafikbeschleunigung des Browsers ein oder nehmen Sie ein schnelleres Gerät.",
        ),
    ),
    AlarmKind(
        key="disconnected",
        severity="critical",
        title=Words(en="Headset disconnected", de="Headset getrennt"),
        remedy=Words(
            en="Check its battery and network. It reconnects automatically.",
            de="Prüfen Sie Akku und Netz. Es verbindet sich automatisch wieder.",
        ),
        remedy_while_paused=Words(
            en="The phase is paused. Check its battery and network; press Resume once it is back.",
            de="Die Phase ist angehalten. Prüfen Sie Akku und Netz; drücken Sie Fortsetzen, "
            "sobald es wieder verbunden ist.",
        ),
    ),
    AlarmKind(
        key="backlog",
        severity="warning",
        title=Words(en="Movement not stored yet", de="Bewegung noch nicht gespeichert"),
        remedy=Words(
            en="The headset keeps it. Check the network and leave the headset on.",
            de="Das Headset behält sie. Prüfen Sie das Netz und lassen Sie das Headset "
            "eingeschaltet.",
        ),
    ),
    AlarmKind(
        key="bad_values",
        severity="warning",
        title=Words(en="Invalid values", de="Ungültige Werte"),
        remedy=Words(
            en="They are stored and left out of summaries. Check the tracking.",
            de="Sie werden gespeichert, aber nicht ausgewertet. Prüfen Sie das Tracking.",
        ),
    ),
    AlarmKind(
        key="frozen",
        severity="warning",
        title=Words(en="Joint frozen", de="Gelenk eingefroren"),
        remedy=Words(
            en="Check the sensor there: battery, strap, view of the base stations.",
            de="Prüfen Sie den Sensor dort: Akku, Band, Sicht zu den Basisstationen.",
        ),
    ),
    AlarmKind(
        key="low_frame_rate",
        severity="warning",
        title=Words(en="Low frame rate", de="Niedrige Bildrate"),
        remedy=Words(
            en="Close other programs; check the headset's cable and temperature.",
            de="Schließen Sie andere Programme; prüfen Sie Kabel und Temperatur des Headsets.",
        ),
    ),
    AlarmKind(
        key="gap",
        severity="warning",
        title=Words(en="Gap in the movement", de="Lücke in der Bewegung"),
        remedy=Words(
            en="Nothing was recorded during it. Repeat the phase if necessary.",
            de="Darin wurde nichts aufgezeichnet. Wiederholen Sie die Phase, falls nötig.",
        ),
    ),
    AlarmKind(
        key="jump",
        severity="warning",
        title=Words(en="Tracking jumped", de="Tracking gesprungen"),
        remedy=Words(
            en="Check the view of the base stations; look at the avatar.",
            de="Prüfen Sie die Sicht zu den Basisstationen; sehen Sie sich den Avatar an.",
        ),
    ),
    AlarmKind(
        key="clock_unknown",
        severity="warning",
        title=Words(en="Headset's clock unknown", de="Uhr des Headsets unbekannt"),
        remedy=Words(
            en="Check the network. The headset's times cannot be compared until its clock is "
            "known.",
            de="Prüfen Sie das Netz. Bis die Uhr bekannt ist, sind Zeiten des Headsets nicht "
            "vergleichbar.",
        ),
    ),
    AlarmKind(
        key="clock_uncertain",
        severity="info",
        title=Words(en="Headset's clock uncertain", de="Uhr des Headsets ungenau"),
        remedy=Words(
            en="The network is slow. Durations are not affected.",
            de="Das Netz ist langsam. Zeitdauern sind nicht betroffen.",
        ),
    ),
    AlarmKind(
        key="storage",
        severity="critical",
        title=Words(en="Data cannot be stored", de="Daten lassen sich nicht speichern"),
        remedy=Words(
            en="Headsets and tablets keep what they have. If the disk is full, delete exports, "
            "end sessions or erase data.",
            de="Headsets und Tablets behalten, was sie haben. Ist die Platte voll, löschen Sie "
            "Exporte oder Daten, oder beenden Sie Sitzungen.",
        ),
    ),
    AlarmKind(
        key="low_disk",
        severity="warning",
        title=Words(
            en="The server's disk is nearly full", de="Die Platte des Servers ist fast voll"
        ),
        remedy=Words(
            en="Free some space before the next session. Everything is still being stored.",
            de="Schaffen Sie vor der nächsten Sitzung Platz. Noch wird alles gespeichert.",
        ),
    ),
    AlarmKind(
        key="writer_failed",
        severity="critical",
        title=Words(en="Recording failed on the server", de="Aufzeichnung im Server gestört"),
        remedy=Words(
            en="Recording is being restarted; headsets keep what they have. If this persists, "
            "restart the server.",
            de="Die Aufzeichnung wird neu gestartet; Headsets behalten, was sie haben. Hält das "
            "an, starten Sie den Server neu.",
        ),
    ),
    AlarmKind(
        key="background_failed",
        severity="warning",
        title=Words(en="Part of the server has failed", de="Ein Teil des Servers ist ausgefallen"),
        remedy=Words(
            en="Recording continues. The server retries automatically; its log says what happened.",
            de="Die Aufzeichnung läuft weiter. Der Server versucht es automatisch erneut; sein "
            "Protokoll nennt den Grund.",
        ),
    ),
    AlarmKind(
        key="stop_rule_met",
        severity="critical",
        title=Words(en="Stop rule met", de="Stoppregel erfüllt"),
        remedy=Words(
            en="Check on the participant, then end the session or continue.",
            de="Sehen Sie nach der Person; beenden Sie dann die Sitzung oder fahren Sie fort.",
        ),
        of_person=True,
    ),
    AlarmKind(
        key="stop_rule_near",
        severity="warning",
        title=Words(en="Sickness is rising", de="Übelkeit nimmt zu"),
        remedy=Words(
            en="Ask how the participant is, and offer a break.",
            de="Fragen Sie, wie es der Person geht, und bieten Sie eine Pause an.",
        ),
        of_person=True,
    ),
    AlarmKind(
        key="stop_rule_unknown",
        severity="warning",
        title=Words(
            en="Stop rule not applied: score missing", de="Stoppregel nicht angewandt: Wert fehlt"
        ),
        remedy=Words(
            en="An answer is missing. Ask the participant how they are.",
            de="Eine Antwort fehlt. Fragen Sie, wie es der Person geht.",
        ),
        of_person=True,
    ),
    AlarmKind(
        key="help_asked",
        severity="critical",
        title=Words(en="The participant is calling you", de="Die Person ruft Sie"),
        remedy=Words(
            en="Go to the participant, then press the button; the tablet then shows that you are "
            "there.",
            de="Gehen Sie zur Person und drücken Sie dann den Knopf; das Tablet zeigt dann, dass "
            "Sie da sind.",
        ),
        of_person=True,
    ),
    AlarmKind(
        key="stop_asked",
        severity="critical",
        title=Words(en="The participant wants to stop", de="Stopp verlangt"),
        remedy=Words(
            en="Go to the participant. Then press the button or resume, or end the session.",
            de="Gehen Sie zur Person. Drücken Sie danach den Knopf oder setzen Sie fort, oder "
            "beenden Sie die Sitzung.",
        ),
        of_person=True,
    ),
    AlarmKind(
        key="feet_untracked",
        severity="warning",
        title=Words(en="Feet not tracked", de="Füße werden nicht verfolgt"),
        remedy=Words(
            en="Check the trackers on the shins. Contacts of the feet are guesses until then; "
            "repeat the phase.",
            de="Prüfen Sie die Tracker an den Unterschenkeln. Bis dahin sind Kontakte der Füße "
            "geraten; wiederholen Sie die Phase.",
        ),
    ),
    AlarmKind(
        key="question_asked",
        severity="critical",
        title=Words(en="The participant has a question", de="Die Person hat eine Frage"),
        remedy=Words(
            en="Go and answer it, then press the button; the tablet then shows that you are there.",
            de="Gehen Sie hin und antworten Sie; drücken Sie dann den Knopf: Das Tablet zeigt, "
            "dass Sie da sind.",
        ),
        of_person=True,
    ),
    AlarmKind(
        key="consent_refused",
        severity="critical",
        title=Words(en="Consent refused", de="Einwilligung abgelehnt"),
        remedy=Words(
            en="Go to the participant, then end the session or show the consent again.",
            de="Gehen Sie zur Person; beenden Sie dann die Sitzung oder zeigen Sie die "
            "Einwilligung erneut.",
        ),
        of_person=True,
    ),
    AlarmKind(
        key="refusal_retracted",
        severity="warning",
        title=Words(en="Refusal taken back", de="Ablehnung zurückgenommen"),
        remedy=Words(
            en="The consent is on the tablet again. Make sure it is a free choice.",
            de="Die Einwilligung ist wieder auf dem Tablet. Vergewissern Sie sich, dass die Wahl "
            "frei ist.",
        ),
        of_person=True,
    ),
    AlarmKind(
        key="impossible",
        severity="warning",
        title=Words(
            en="Impossible data from the headset", de="Daten des Headsets können nicht stimmen"
        ),
        remedy=Words(
            en="The session does not count. Check the headset's software before the next "
            "participant.",
            de="Die Sitzung zählt nicht. Prüfen Sie vor der nächsten Person die Software des "
            "Headsets.",
        ),
    ),
    AlarmKind(
        key="doubtful",
        severity="warning",
        title=Words(en="The phase does not count", de="Die Phase zählt nicht"),
        remedy=Words(
            en="Its data cannot be right; the list of alarms says why. Repeat the phase, or check "
            "the headset's software.",
            de="Ihre Daten können nicht stimmen; die Liste der Alarme nennt den Grund. "
            "Wiederholen Sie die Phase oder prüfen Sie die Software des Headsets.",
        ),
    ),
)


def alarm_texts() -> dict[str, Words]:
    """Return the texts of all alarms by their keys in the pages' text tables."""
    texts = {}
    for one in ALARMS:
        texts[f"alarm.{one.key}"] = one.title
        texts[f"alarm.{one.key}.do"] = one.remedy
        if one.remedy_while_paused is not None:
            texts[f"alarm.{one.key}.paused"] = one.remedy_while_paused
    return texts
