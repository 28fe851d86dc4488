"""Tests of the preregistration in a study file: part of the content, checked with the rest."""

import json

import pytest

from tests.protocol.helpers import BEFORE_RULES, STUDY, loaded, problems
from tests.protocol.test_options import SHIPPED

SECTION = """
preregistration:
  alpha: 0.05
  planned_n: 12
  primary:
    {measure: score, instrument: karas2020, score: agency, limb: hand,
     test: page_trend, direction: falls}
  exclusions:
    - {rule: complete_session}
    - {rule: minimum_frame_rate_hz, limit: 60}
"""


def test_a_study_without_preregistration_keeps_its_hash() -> None:
    """A study without preregistration has the hash that it had before the key existed."""
    assert loaded(BEFORE_RULES).content_hash == SHIPPED
    assert "preregistration" not in json.loads(loaded(BEFORE_RULES).canonical_json)


def test_declaring_changes_the_content_and_not_the_balance() -> None:
    """A preregistration changes the content hash but not the design hash."""
    declared = loaded(STUDY + SECTION)
    assert declared.content_hash != loaded().content_hash
    assert declared.protocol.design_hash == loaded().protocol.design_hash
    preregistration = declared.protocol.preregistration
    assert preregistration is not None
    assert (preregistration.primary.test, preregistration.primary.correction) == (
        "page_trend",
        "none",
    )
    stricter = loaded(STUDY + SECTION.replace("0.05", "0.01"))
    assert stricter.content_hash != declared.content_hash


@pytest.mark.parametrize(
    ("old", "new", "path"),
    [
        ("score: agency", "score: joy", "primary.score"),
        ("karas2020, score: agency", "fms, score: sickness_score", "primary.instrument"),
        ("direction: falls", "direction: two_sided", "primary.direction"),
        ("direction: falls", "direction: falls, correction: holm", "primary.correction"),
        ("direction: falls", "direction: falls, reference: latency_0", "primary.reference"),
        (", score: agency", "", "primary.measure"),
        ("test: page_trend", "test: against_reference, reference: slow", "primary.reference"),
        ("limit: 60", "limit: 0", "exclusions[1].limit"),
        ("complete_session}", "complete_session, limit: 3}", "exclusions[0].limit"),
        ("alpha: 0.05", "alpha: 5", "alpha"),
        ("minimum_frame_rate_hz, limit: 60", "complete_session", "exclusions[1].rule"),
    ],
)  # fmt: skip
def test_an_impossible_preregistration_is_rejected_at_its_place(
    old: str, new: str, path: str
) -> None:
    """A preregistration that does not fit the study raises an error that states path and remedy."""
    assert old in SECTION
    (problem,) = problems(STUDY + SECTION.replace(old, new))
    assert (problem.path, bool(problem.remedy)) == (f"preregistration.{path}", True)
