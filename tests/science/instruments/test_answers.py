"""Tests of validating submitted answers, and of the order in which items are asked."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.science.instruments import item_order, validate_answers
from tests.science.instruments.helpers import shipped, small

KARAS = shipped("karas2020")
DEMOGRAPHICS = shipped("demographics")
PERSON: dict[str, object] = {
    "age": 31,
    "sex": "not_stated",
    "height_cm": 171.5,
    "occupation": "Physics",
    "handedness": "left",
    "footedness": "both",
    "vision": True,
    "colour_blind": False,
    "stereo_vision": True,
    "motion_sickness": False,
    "hand_eye_coordination": 4,
    "foot_eye_coordination": 3.0,
    "vr_familiarity": 1,
}


def test_a_complete_form_has_no_problem() -> None:
    """A complete form is valid; optional items may be missing, and whole numbers be floats."""
    assert validate_answers(DEMOGRAPHICS, PERSON) == ()
    assert validate_answers(DEMOGRAPHICS, {**PERSON, "weight_kg": None}) == ()
    assert validate_answers(DEMOGRAPHICS, {**PERSON, "sex_self_description": " "}) == ()


@pytest.mark.parametrize(
    ("item", "value"),
    [
        ("age", 31.5),
        ("age", 12),
        ("age", "31"),
        ("age", True),
        ("age", None),
        ("sex", "m"),
        ("sex", ["male"]),
        ("height_cm", 1.71),
        ("height_cm", math.nan),
        ("height_cm", math.inf),
        ("occupation", "  "),
        ("occupation", "x" * 201),
        ("occupation", "a\0b"),
        ("occupation", 7),
        ("vision", 1),
        ("vision", "yes"),
        ("vr_familiarity", 6),
    ],
)
def test_an_invalid_answer_is_reported_with_what_is_valid(item: str, value: object) -> None:
    """An answer of wrong type, range or length is reported with what is valid."""
    (problem,) = validate_answers(DEMOGRAPHICS, {**PERSON, item: value})
    assert problem.item == item
    assert problem.valid
    assert problem.remedy


def test_all_problems_are_reported_in_the_order_of_the_items() -> None:
    """An empty form lists every required item in order; an unknown item comes last."""
    problems = validate_answers(DEMOGRAPHICS, {"q1": 3})
    required = [item.key for item in DEMOGRAPHICS.items if item.required]
    assert [problem.item for problem in problems] == [*required, "q1"]


def test_ranges_are_described_in_words() -> None:
    """One-sided ranges and units appear in the description of what is valid."""
    (problem,) = validate_answers(small(), {"q1": 1, "q2": 1, "size": -3})
    assert problem.valid == "a number of at least 0 cm"


@given(st.integers(0, 2**63 - 1))
def test_every_order_asks_each_item_once_and_the_prompt_last(seed: int) -> None:
    """Every order is a permutation of the items with the open prompt last."""
    order = item_order(KARAS, seed)
    assert sorted(order) == sorted(KARAS.by_key)
    assert order[-1] == "problems"
    assert order == item_order(KARAS, seed)


def test_orders_differ_between_seeds() -> None:
    """Each of the 14 items comes first for some seed."""
    assert {item_order(KARAS, seed)[0] for seed in range(200)} == {
        item.key for item in KARAS.items if item.type == "likert"
    }


def test_an_order_is_the_same_in_every_release() -> None:
    """A seed gives the same order in every release, since seeds are stored with the answers."""
    assert item_order(KARAS, 1)[:5] == EXPECTED_START


def test_an_instrument_that_does_not_shuffle_keeps_its_order() -> None:
    """Without shuffling, the seed has no effect on the order of the items."""
    assert item_order(DEMOGRAPHICS, 1) == tuple(DEMOGRAPHICS.by_key)
    assert item_order(small(last=("q1",)), 2) == ("q2", "size", "yes", "note", "q1")


EXPECTED_START = ("q2", "q11", "q8", "q10", "q14")


def test_an_item_with_a_scale_of_its_own_takes_its_steps_only() -> None:
    """An item with its own scale accepts only its steps; the others keep the instrument's scale."""
    tlx = shipped("raw_tlx")
    answers: dict[str, object] = dict.fromkeys(tlx.by_key, 50)
    assert validate_answers(tlx, answers) == ()
    for value in (-5, 105, 52, 2.5):
        (problem,) = validate_answers(tlx, {**answers, "performance": value})
        assert problem.item == "performance"
        assert problem.valid == "a whole number from 0 to 100 in steps of 5"
