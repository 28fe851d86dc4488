"""Tests of why no outcome of the signed-rank tests could be significant."""

import numpy as np
import pytest

from app.database import Database
from app.features.results.analysis.material import read_material
from app.features.results.analysis.questions.answers import answers_of
from app.features.results.analysis.questions.limb_tests import signed_floor
from app.science.statistics import FloatArray, against_reference
from tests.features.builders import STUDY, SessionSpec, build_session

LEVELS = ("0", "125", "350")
RISING = np.arange(3.0)


def _floor(values: FloatArray) -> str:
    return signed_floor(against_reference(values, LEVELS, "0"))


def test_equal_answers_are_not_called_too_few_participants() -> None:
    """Twelve participants are enough: if few of them differ, equal values are the reason."""
    equal = np.full((12, 3), 4.0)
    assert _floor(equal + RISING) == ""
    said = _floor(equal)
    assert said == "No result is possible: 12 participants have equal values in all comparisons."
    equal[:3] += RISING
    said = _floor(equal)
    assert said.startswith("Too many equal values for any result: of 12 participants at most 3 ")
    assert "the smallest possible adjusted p is .500" in said


def test_too_few_participants_are_called_so() -> None:
    """Three participants are too few, however large every difference is."""
    assert _floor(np.full((3, 3), 4.0) + RISING).startswith(
        "Too few participants for any result: with 3 differences other than zero"
    )


@pytest.mark.one_engine
def test_equal_answers_have_no_test_of_ranks(database: Database) -> None:
    """If everybody answers the same in every condition, no test on ranks has a p value."""
    with database.writing() as db:
        for at in range(6):
            build_session(db, SessionSpec(f"P-{at:04d}", likert=lambda _step, _item: 4))
    with database.reading() as db:
        found = answers_of(read_material(db, STUDY, "people"))
    (agency,) = (one for one in found.measures if one.key == "karas2020_agency")
    results = {one.key: one for one in agency.results}
    for key in ("friedman_hand", "trend_hand"):
        assert results[key].sentence.startswith("This cannot be tested. Each of 6 subjects")
        assert results[key].apa == ""
    assert "not tested" in results["planned_hand"].apa
    assert any(one.startswith("No result is possible") for one in results["planned_hand"].warnings)
