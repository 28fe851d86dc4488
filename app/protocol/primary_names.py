"""What a study and its instrument call the things that the primary test names by their keys."""

from collections.abc import Mapping
from dataclasses import dataclass

from app.protocol.preregistration import PrimaryTest
from app.protocol.study import StudyProtocol
from app.science.instruments import Instrument
from app.texts import Words


@dataclass(frozen=True)
class PrimaryNames:
    """What study and instrument call what the primary test names by key, each by language.

    Null for what it does not name.
    """

    instrument: dict[str, str] | None
    score: dict[str, str] | None
    reference: dict[str, str] | None


PRIMARY_MEASURES = {
    "contact_time": Words(en="contact time (s)", de="Kontaktzeit (s)"),
    "completions": Words(en="completed tasks", de="erledigte Aufgaben"),
}
"""The measures of a primary test that are no scores."""
PRIMARY_DIRECTIONS = {
    "two_sided": Words(en="two-sided", de="zweiseitig"),
    "rises": Words(en="it rises", de="steigend"),
    "falls": Words(en="it falls", de="fallend"),
}
NO_NAMES = PrimaryNames(None, None, None)
"""Where nothing but the keys is known."""


def primary_names(
    primary: PrimaryTest, study: StudyProtocol, instruments: Mapping[str, Instrument]
) -> PrimaryNames:
    """Return the names of what a primary test of the study refers to."""
    labels = {one.key: dict(one.label) for one in study.conditions}
    reference = None if primary.reference is None else labels.get(primary.reference)
    instrument = instruments.get(primary.instrument or "")
    if instrument is None:
        return PrimaryNames(None, None, reference)
    scores = {one.key: dict(one.label) for one in instrument.scores}
    return PrimaryNames(dict(instrument.title), scores.get(primary.score or ""), reference)
