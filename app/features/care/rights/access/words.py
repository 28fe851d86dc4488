"""The fixed texts of a participant's own copy; English if a language is missing."""

from collections.abc import Mapping

EN: Mapping[str, str] = {
    "title": "Your data",
    "lead": "Everything that this study keeps about you, as of {date}.",
    "code": "Your code in the study",
    "study": "Study",
    "visit": "Visit of {date}",
    "status": "How it ended",
    "completed": "completed",
    "aborted": "ended early by the lab",
    "withdrawn": "you withdrew",
    "active": "not ended yet",
    "planned": "not started yet",
    "language": "Language",
    "kept": "What was recorded",
    "frames": "{count} frames of movement, in samples/",
    "contacts": "{count} contacts and {completions} completed tasks",
    "consent": "Consent",
    "consent_given": "Given on {date}.",
    "consent_none": "No consent is on record.",
    "height": "Height",
    "height_text": "stated {stated} m, matched {matched} m",
    "answers": "Your answers",
    "no_answers": "No form was filled in.",
    "left_out": "left out",
    "yes": "yes",
    "no": "no",
    "was": "corrected on {date}; it was: {previous}. Why: {reason}",
    "scores": "Scores computed from them",
    "no_score": "none: an answer is missing",
    "range": "from {minimum} to {maximum}",
    "notes": "What the lab wrote down",
    "no_notes": "Nothing.",
    "note": "Note",
    "reason": "Reason given for a pause, a repetition, a skipped step or the end",
    "refused_form": "Answers that arrived too late and do not count",
    "data": "The data themselves",
    "data_text": (
        "The other files contain the same data and more as tables, including every sample of "
        "your movement. codebook.csv explains each column."
    ),
}
DE: Mapping[str, str] = {
    "title": "Ihre Daten",
    "lead": "Alles, was diese Studie über Sie aufbewahrt (Stand: {date}).",
    "code": "Ihr Code in der Studie",
    "study": "Studie",
    "visit": "Besuch vom {date}",
    "status": "Wie er endete",
    "completed": "abgeschlossen",
    "aborted": "vom Labor abgebrochen",
    "withdrawn": "Sie haben Ihre Teilnahme beendet",
    "active": "noch nicht beendet",
    "planned": "noch nicht begonnen",
    "language": "Sprache",
    "kept": "Was aufgezeichnet wurde",
    "frames": "{count} Bewegungsbilder, in samples/",
    "contacts": "{count} Kontakte und {completions} erledigte Aufgaben",
    "consent": "Einwilligung",
    "consent_given": "Erteilt am {date}.",
    "consent_none": "Es ist keine Einwilligung verzeichnet.",
    "height": "Körpergröße",
    "height_text": "angegeben {stated} m, angeglichen {matched} m",
    "answers": "Ihre Antworten",
    "no_answers": "Es wurde kein Formular ausgefüllt.",
    "left_out": "ausgelassen",
    "yes": "ja",
    "no": "nein",
    "was": "berichtigt am {date}; vorher: {previous}. Warum: {reason}",
    "scores": "Daraus berechnete Werte",
    "no_score": "keiner: eine Antwort fehlt",
    "range": "von {minimum} bis {maximum}",
    "notes": "Was das Labor notiert hat",
    "no_notes": "Nichts.",
    "note": "Notiz",
    "reason": (
        "Grund für eine Pause, eine Wiederholung, einen übersprungenen Schritt oder das Ende"
    ),
    "refused_form": "Antworten, die zu spät kamen und nicht zählen",
    "data": "Die Daten selbst",
    "data_text": (
        "Die anderen Dateien enthalten dieselben Daten und weitere als Tabellen, mit jedem "
        "Messwert Ihrer Bewegung. codebook.csv erklärt jede Spalte (auf Englisch)."
    ),
}
WORDS: Mapping[str, Mapping[str, str]] = {"en": EN, "de": DE}


def words_of(language: str) -> Mapping[str, str]:
    """Return the texts in a language, or in English."""
    return WORDS.get(language, EN)


def in_language(text: Mapping[str, str], language: str) -> str:
    """Return a text of the study in a language, or in the first one that it has."""
    return text.get(language) or next(iter(text.values()), "")
