"""The names of steps in English and German, used where a study gives no title of its own."""

from collections.abc import Mapping

DEFAULT_TITLES: dict[str, dict[str, str]] = {
    "consent": {"en": "Consent", "de": "Einwilligung"},
    "form": {"en": "Questions", "de": "Fragen"},
    "instructions": {"en": "Instructions", "de": "Anleitung"},
    "height": {"en": "Height", "de": "Körpergröße"},
    "materialise": {"en": "Entering the body", "de": "Eintritt in den Körper"},
    "free_roam": {"en": "Free movement", "de": "Freies Bewegen"},
    "practice_hand": {"en": "Practice with the hand", "de": "Übung mit der Hand"},
    "practice_foot": {"en": "Practice with the foot", "de": "Übung mit dem Fuß"},
    "hand": {"en": "Hand task", "de": "Handaufgabe"},
    "foot": {"en": "Foot task", "de": "Fußaufgabe"},
    "questionnaire": {"en": "Questionnaire", "de": "Fragebogen"},
    "debrief": {"en": "Debriefing", "de": "Abschluss"},
}
DEFAULT_LANGUAGES = frozenset({"en", "de"})


def title_of(kind: str, given: Mapping[str, str] | None) -> Mapping[str, str]:
    """The given title, or the built-in one of the step's kind (of its limb for a task)."""
    return DEFAULT_TITLES[kind] if given is None else given
