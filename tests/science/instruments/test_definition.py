"""Tests that all contradictions in an instrument's definition are found and reported."""

from collections.abc import Sequence

import pytest

from app.science.instruments import (
    Choice,
    Instrument,
    InstrumentDefinitionError,
    Item,
    Scale,
    Score,
)
from tests.science.instruments.helpers import shipped, small

ONE = {"en": "One"}


def likert(key: str) -> Item:
    """Return a Likert item."""
    return Item(key, ONE, "likert")


@pytest.mark.parametrize(
    ("changes", "path", "expected_message"),
    [
        ({"key": "Small"}, ("key",), "not a valid key"),
        ({"version": 0}, ("version",), "from 1"),
        ({"items": (), "scores": ()}, ("items",), "no item"),
        ({"languages": ()}, ("languages",), "No language"),
        ({"languages": ("en", "en")}, ("languages", 1), "twice"),
        ({"languages": ("en", "de")}, ("title", "de"), "'de'"),
        ({"title": {"en": " "}}, ("title", "en"), "missing in"),
        ({"items": (likert("q1"), likert("q1")), "scores": ()}, ("items", 1, "key"), "taken"),
        ({"items": (likert("mean"),), "scores": ()}, ("items", 0, "key"), "taken"),
        ({"scores": (Score("q1", ONE, "q2"),)}, ("scores", 0, "key"), "taken"),
        ({"scores": (Score("s", ONE, "q1 + q7"),)}, ("scores", 0, "formula"), "character 6"),
        ({"scores": (Score("s", ONE, "note + 1"),)}, ("scores", 0, "formula"), "'note'"),
        (
            {"scores": (Score("s", ONE, "t"), Score("t", ONE, "q1"))},
            ("scores", 0, "formula"),
            "'t'",
        ),
        ({"scores": (Score("s", ONE, "q1", 3, 1),)}, ("scores", 0, "maximum"), "empty"),
        ({"recode": "y - 4"}, ("recode",), "'y'"),
        ({"last": ("q9",)}, ("last", 0), "'q9'"),
        ({"scale": Scale(7, 1, ())}, ("scale", "maximum"), "steps"),
        ({"scale": Scale(1, 7, (ONE,) * 3)}, ("scale", "labels"), "3 labels"),
        ({"scale": None}, ("items", 0, "type"), "scale"),
        ({"scale": Scale(0, 100, (), step=0)}, ("scale", "step"), "whole number"),
        ({"scale": Scale(0, 100, (), step=30)}, ("scale", "step"), "do not reach 100"),
        (
            {"items": (Item("q1", ONE, "likert", scale=Scale(3, 3, ())),), "scores": ()},
            ("items", 0, "scale", "maximum"),
            "1 steps",
        ),
        (
            {"items": (Item("q1", ONE, "text", scale=Scale(1, 7, ())),), "scores": ()},
            ("items", 0, "scale"),
            "no meaning",
        ),
        (
            {"items": (Item("q1", ONE, "likert", scale=Scale(1, 2, (ONE, {}))),), "scores": ()},
            ("items", 0, "scale", "labels", 1, "en"),
            "missing in",
        ),
    ],
)
def test_contradictions_are_reported_at_their_place(
    changes: dict[str, object], path: tuple[str | int, ...], expected_message: str
) -> None:
    """Each contradiction in a definition is reported with its path and a sentence."""
    with pytest.raises(InstrumentDefinitionError) as caught:
        small(**changes)
    problem = next(one for one in caught.value.problems if one.path == path)
    assert expected_message in problem.message
    assert problem.remedy


@pytest.mark.parametrize(
    ("item", "field"),
    [
        (Item("a", ONE, "likert", minimum=1), "minimum"),
        (Item("a", ONE, "text", unit="cm"), "unit"),
        (Item("a", ONE, "number", reverse_keyed=True), "reverse_keyed"),
        (Item("a", ONE, "boolean", choices=(Choice("x", ONE), Choice("y", ONE))), "choices"),
        (Item("a", ONE, "choice", choices=(Choice("x", ONE),)), "choices"),
        (Item("a", ONE, "number", minimum=3, maximum=2), "maximum"),
        (Item("a", ONE, "integer", max_length=3), "max_length"),
        (Item("a", ONE, "text", max_length=0), "max_length"),
    ],
)
def test_an_item_has_only_the_fields_of_its_type(item: Item, field: str) -> None:
    """An item with a field of another type, or without one of its own, is rejected."""
    with pytest.raises(InstrumentDefinitionError) as caught:
        small(items=(item,), scores=())
    assert ("items", 0, field) in [problem.path for problem in caught.value.problems]


def test_all_contradictions_are_reported_together() -> None:
    """Several contradictions in a definition are reported together."""
    with pytest.raises(InstrumentDefinitionError) as caught:
        small(key="!", version=0, last=("q9",), scores=(Score("s", ONE, "q1 +"),))
    paths: Sequence[object] = [problem.path for problem in caught.value.problems]
    assert paths == [("key",), ("version",), ("last", 0), ("scores", 0, "formula")]


def test_the_embodiment_questionnaire_is_complete() -> None:
    """The embodiment questionnaire has 14 items on 7 steps and a final open prompt.

    Karas 2020, appendix A.3.
    """
    karas = shipped("karas2020")
    assert [item.key for item in karas.items] == [
        *(f"q{number}" for number in range(1, 15)),
        "problems",
    ]
    assert karas.scale is not None
    assert [label["en"] for label in karas.scale.labels] == [
        "strongly disagree",
        "disagree",
        "somewhat disagree",
        "neither agree nor disagree",
        "somewhat agree",
        "agree",
        "strongly agree",
    ]
    reverse = [item.key for item in karas.items if item.reverse_keyed]
    assert reverse == ["q2", "q3", "q5", "q9", "q11"]
    assert karas.last == ("problems",)


@pytest.mark.parametrize(
    ("key", "wording"),
    [
        ("q1", "I felt as if the virtual body I saw when I looked down was my own body."),
        ("q5", "I felt as if the character I saw when looking in the mirror was another person."),
        ("q7", "The movements of the virtual body were caused by my movements."),
        (
            "q12",
            (
                "I felt as if my (real) body were drifting towards the virtual body or as if the "
                "virtual body were drifting towards my real body."
            ),
        ),
        ("q13", "I felt as if my real body were turning into an 'avatar' body."),
        ("q14", "I felt that the motion of the virtual body was simultaneous to my movement."),
        ("problems", "Something that caused me problems or that I struggled with was..."),
    ],
)
def test_wordings_of_the_embodiment_questionnaire(key: str, wording: str) -> None:
    """The embodiment questionnaire's items are worded exactly as in Karas 2020, appendix A.3."""
    assert shipped("karas2020").by_key[key].text["en"] == wording


def test_demographics_ask_what_the_tasks_need() -> None:
    """The demographics ask for the handedness that the hand task needs, never for the code."""
    demographics: Instrument = shipped("demographics")
    choices = {key: [c.key for c in demographics.by_key[key].choices] for key in HANDS_AND_FEET}
    assert choices == HANDS_AND_FEET
    assert demographics.by_key["height_cm"].unit == "cm"
    assert not demographics.by_key["weight_kg"].required
    assert not any("id" in item.key.split("_") for item in demographics.items)


HANDS_AND_FEET = {"handedness": ["left", "right"], "footedness": ["left", "right", "both"]}
