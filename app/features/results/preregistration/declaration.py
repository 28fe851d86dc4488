"""Find which version declared the preregistration, and describe it in words."""

from dataclasses import dataclass
from datetime import datetime

from sqlalchemy.orm import Session

from app.features.design.instruments import instrument_of
from app.features.design.studies import instrument_for, protocol_of
from app.features.results.preregistration.schemas import DeclarationView
from app.models import StudyVersion
from app.protocol import (
    PRIMARY_DIRECTIONS,
    PRIMARY_MEASURES,
    ExclusionRule,
    Preregistration,
    PrimaryNames,
    PrimaryTest,
    primary_names,
)
from app.science.statistical_tests import statistical_test

RULES = {
    "complete_session": "sessions that were not completed",
    "minimum_frame_rate_hz": "a task phase below {limit:g} frames per second",
    "minimum_share_of_frames": "a task phase with less than {limit:.0%} of its time in frames",
    "maximum_latency_error_ms": "a task phase whose latency is off by more than {limit:g} ms",
    "minimum_active_time_s": "a task phase shorter than {limit:g} s of active time",
    "maximum_straight_lined_forms": "more than {limit:g} forms with identical ratings",
}


@dataclass(frozen=True)
class Declared:
    """The current declaration, and the version that first made it."""

    preregistration: Preregistration
    version: StudyVersion

    def view(self, frozen_at: datetime | None, names: PrimaryNames) -> DeclarationView:
        """Return the declaration as a response model."""
        own = self.preregistration
        return DeclarationView(
            version=self.version.number,
            content_hash=self.version.content_hash,
            created_at=self.version.created_at,
            frozen_at=frozen_at,
            registration=own.registration,
            alpha=own.alpha,
            planned_n=own.planned_n,
            section=own,
            names=names,
            primary_words=primary_words(own.primary),
            rules=[rule_words(rule) for rule in own.exclusions],
        )


def declared_in(version: StudyVersion) -> Preregistration | None:
    """Return the preregistration of a version, if it has one."""
    return protocol_of(version).preregistration


def declaration_of(versions: list[StudyVersion]) -> Declared | None:
    """Return the newest version's declaration and the version that introduced it.

    That is the first of the consecutive versions, up to the newest, with this declaration.
    """
    newest = declared_in(versions[-1])
    if newest is None:
        return None
    first = versions[-1]
    for version in reversed(versions):
        if declared_in(version) != newest:
            break
        first = version
    return Declared(newest, first)


def names_in(db: Session, declared: Declared) -> PrimaryNames:
    """Return the names of what the primary test refers to, as of the version that declared it."""
    primary, version = declared.preregistration.primary, declared.version
    key = primary.instrument
    own = {} if key is None else {key: instrument_of(instrument_for(db, version, key))}
    return primary_names(primary, protocol_of(version), own)


def primary_words(primary: PrimaryTest) -> str:
    """Return the primary test as a sentence."""
    if primary.measure == "score":
        measure = f"the score {primary.score} of {primary.instrument}"
    else:
        measure = PRIMARY_MEASURES[primary.measure].en
    limb = {"both": "the mean of both tasks"}.get(primary.limb, f"the {primary.limb} task")
    words = f"{statistical_test(primary.test).phrase} of {measure} in {limb}, by added latency"
    if primary.reference is not None:
        words += f", against {primary.reference}"
    corrected = ", corrected by Holm's rule" if primary.correction == "holm" else ""
    return f"{words}; {PRIMARY_DIRECTIONS[primary.direction].en}{corrected}."


def rule_words(rule: ExclusionRule) -> str:
    """Return a description of what an exclusion rule leaves out."""
    return RULES[rule.rule].format(limit=rule.limit if rule.limit is not None else 0.0)
