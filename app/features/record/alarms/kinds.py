"""The registry of alarms: the severity, title and remedy of each.

To add an alarm, add an entry to `ALARMS` and raise the alarm where it is detected, usually in one
of the `*_watch.py` modules in this folder. The cockpit's texts in both languages are generated from
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
        title=Words(en="Headset silent", de="Headset stumm"),
        remedy=Words(
            en="Wake the headset, or check that it is worn.",
            de="Headset aufwecken oder prüfen, ob es getragen wird.",
        ),
        remedy_while_paused=Words(
            en="The phase is paused. Wake the headset; then press Resume.",
            de="Die Phase ist angehalten. Headset aufwecken, dann Fortsetzen drücken.",
        ),
    ),
    AlarmKind(
        key="disconnected",
        severity="critical",
        title=Words(en="Headset disconnected", de="Headset getrennt"),
        remedy=Words(
            en="Check its battery and network. It reconnects automatically.",
            de="Akku und Netz prüfen. Es verbindet sich von selbst wieder.",
        ),
        remedy_while_paused=Words(
            en="The phase is paused. Check battery and network; once it is back, press Resume.",
            de="Die Phase ist angehalten. Akku und Netz prüfen; sobald es wieder da ist, "
            "Fortsetzen drücken.",
        ),
    ),
    AlarmKind(
        key="backlog",
        severity="warning",
        title=Words(en="Movement not stored", de="Bewegung ungesichert"),
        remedy=Words(
            en="The headset keeps it. Check the network and leave the headset on.",
            de="Das Headset behält sie. Netz prüfen; Headset eingeschaltet lassen.",
        ),
    ),
    AlarmKind(
        key="bad_values",
        severity="warning",
        title=Words(en="Broken values", de="Defekte Werte"),
        remedy=Words(
            en="They are stored and left out of summaries. Check the tracking.",
            de="Gespeichert, aber nicht ausgewertet. Tracking prüfen.",
        ),
    ),
    AlarmKind(
        key="frozen",
        severity="warning",
        title=Words(en="Joint frozen", de="Gelenk eingefroren"),
        remedy=Words(
            en="Check that sensor: battery, strap, view of the base stations.",
            de="Sensor dort prüfen: Akku, Band, Sicht der Basisstationen.",
        ),
    ),
    AlarmKind(
        key="low_frame_rate",
        severity="warning",
        title=Words(en="Low frame rate", de="Niedrige Bildrate"),
        remedy=Words(
            en="Close other programs; check the headset's cable and temperature.",
            de="Andere Programme schließen; Kabel und Wärme des Headsets prüfen.",
        ),
    ),
    AlarmKind(
        key="gap",
        severity="warning",
        title=Words(en="Gap in the movement", de="Lücke in der Bewegung"),
        remedy=Words(
            en="Nothing was recorded in it. Repeat the phase if it matters.",
            de="Darin wurde nichts aufgezeichnet. Phase wiederholen, falls es stört.",
        ),
    ),
    AlarmKind(
        key="jump",
        severity="warning",
        title=Words(en="Tracking jumped", de="Tracking gesprungen"),
        remedy=Words(
            en="Check the view of the base stations; look at the avatar.",
            de="Sicht der Basisstationen prüfen; den Avatar ansehen.",
        ),
    ),
    AlarmKind(
        key="clock_unknown",
        severity="warning",
        title=Words(en="Headset's clock unknown", de="Uhr des Headsets unbekannt"),
        remedy=Words(
            en="Check the network. Its times cannot be compared until then.",
            de="Netz prüfen. Bis dahin sind seine Zeiten nicht vergleichbar.",
        ),
    ),
    AlarmKind(
        key="clock_uncertain",
        severity="info",
        title=Words(en="Headset's clock uncertain", de="Uhr des Headsets ungenau"),
        remedy=Words(
            en="The network is slow. Durations are not affected.",
            de="Das Netz ist langsam. Dauern sind nicht betroffen.",
        ),
    ),
    AlarmKind(
        key="storage",
        severity="critical",
        title=Words(en="Nothing can be stored", de="Nichts kann gespeichert werden"),
        remedy=Words(
            en="Headsets and tablets keep what they have. Disk full? Delete exports, end sessions "
            "or erase data.",
            de="Headsets und Tablets behalten, was sie haben. Platte voll? Exporte löschen, "
            "Sitzungen beenden oder Daten löschen.",
        ),
    ),
    AlarmKind(
        key="low_disk",
        severity="warning",
        title=Words(
            en="Little space on the server's disk", de="Wenig Platz auf der Platte des Servers"
        ),
        remedy=Words(
            en="Free some space before the next session. Everything is still being stored.",
            de="Vor der nächsten Sitzung Platz schaffen. Noch wird alles gespeichert.",
        ),
    ),
    AlarmKind(
        key="writer_failed",
        severity="critical",
        title=Words(en="The server has a fault", de="Störung im Server"),
        remedy=Words(
            en="Recording is being restarted; headsets keep what they have. If this stays, "
            "restart the server.",
            de="Die Aufzeichnung wird neu gestartet; Headsets behalten, was sie haben. Hält das "
            "an, den Server neu starten.",
        ),
    ),
    AlarmKind(
        key="background_failed",
        severity="warning",
        title=Words(en="Part of the server has failed", de="Ein Teil des Servers ist ausgefallen"),
        remedy=Words(
            en="Recording goes on. The server retries automatically; its log says what happened.",
            de="Die Aufzeichnung läuft weiter. Der Server versucht es von selbst erneut; sein "
            "Protokoll nennt den Grund.",
        ),
    ),
    AlarmKind(
        key="stop_rule_met",
        severity="critical",
        title=Words(en="Stop rule met", de="Stoppregel erfüllt"),
        remedy=Words(
            en="Check on the participant; then end the session or continue.",
            de="Nach der Person sehen; dann die Sitzung beenden oder fortfahren.",
        ),
        of_person=True,
    ),
    AlarmKind(
        key="stop_rule_near",
        severity="warning",
        title=Words(en="Sickness is rising", de="Übelkeit nimmt zu"),
        remedy=Words(
            en="Ask how the participant is, and offer a break.",
            de="Fragen, wie es der Person geht, und eine Pause anbieten.",
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
            en="An answer was left out. Ask the participant how they are.",
            de="Eine Antwort fehlt. Fragen, wie es der Person geht.",
        ),
        of_person=True,
    ),
    AlarmKind(
        key="help_asked",
        severity="critical",
        title=Words(en="The participant is calling you", de="Die Person ruft Sie"),
        remedy=Words(
            en="Go to them. Press when you are there, so that the tablet can say so.",
            de="Nachsehen. Drücken, wenn Sie da sind: Das Tablet zeigt es auch.",
        ),
        of_person=True,
    ),
    AlarmKind(
        key="question_asked",
        severity="critical",
        title=Words(en="The participant has a question", de="Die Person hat eine Frage"),
        remedy=Words(
            en="Go and answer it. Press when you are there, so that the tablet can say so.",
            de="Hingehen und antworten. Drücken, wenn Sie da sind: Das Tablet zeigt es auch.",
        ),
        of_person=True,
    ),
    AlarmKind(
        key="consent_refused",
        severity="critical",
        title=Words(en="Consent refused", de="Einwilligung abgelehnt"),
        remedy=Words(
            en="Go to the participant; then end the session, or show the consent again.",
            de="Zur Person gehen; dann die Sitzung beenden oder die Einwilligung erneut zeigen.",
        ),
        of_person=True,
    ),
    AlarmKind(
        key="refusal_retracted",
        severity="warning",
        title=Words(en="Refusal withdrawn", de="Ablehnung zurückgenommen"),
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
        title=Words(en="Headset data cannot be true", de="Daten des Headsets unmöglich"),
        remedy=Words(
            en="The session does not count. Check the headset's software before the next "
            "participant.",
            de="Die Sitzung zählt nicht. Vor der nächsten Person die Software des Headsets prüfen.",
        ),
    ),
    AlarmKind(
        key="doubtful",
        severity="warning",
        title=Words(en="The phase does not count", de="Die Phase zählt nicht"),
        remedy=Words(
            en="Its data cannot be true; the list of alarms says why. Repeat it, or check the "
            "headset's software.",
            de="Ihre Daten können nicht stimmen; die Liste der Alarme sagt, warum. Wiederholen "
            "oder die Software des Headsets prüfen.",
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
