"""Tests of the dry run of a visit: exact times of the study, and marked estimates."""

from itertools import pairwise

import pytest

from app.protocol import compile_plan, sequences
from app.protocol.durations import ITEM_S, OPENING_S, form_s, timeline, total_s
from tests.protocol.helpers import instruments, study


def test_the_shipped_study_sets_nine_minutes() -> None:
    """The shipped study sets nine minutes: free movement of 120 s and six tasks of 5 + 60 + 5 s.

    Karas 2020, chapter 7.1.
    """
    protocol = study()
    plan = compile_plan(protocol, sequences(protocol)[0])
    steps = timeline(protocol, plan, instruments(), language="en")
    assert sum(step.length_s for step in steps if not step.estimated) == 120 + 6 * 70
    assert {step.step.kind for step in steps if not step.estimated} == {"free_roam", "task"}


def test_steps_follow_one_another() -> None:
    """Each step begins when the previous one ends, and the total is the end of the last."""
    protocol = study()
    plan = compile_plan(protocol, sequences(protocol)[3])
    steps = timeline(protocol, plan, instruments(), language="de")
    for one, other in pairwise(steps):
        assert other.start_s == pytest.approx(one.start_s + one.length_s)
    assert total_s(steps) == pytest.approx(steps[-1].start_s + steps[-1].length_s)


def test_a_forms_duration_depends_on_its_items() -> None:
    """The duration of a form depends on its items; the sickness questionnaire has 16."""
    assert form_s(instruments()["ssq"]) == OPENING_S + 16 * ITEM_S["likert"]


def test_an_unknown_instrument_gets_a_rough_estimate() -> None:
    """A form of an unknown instrument or language gets an estimate instead of an error."""
    protocol = study()
    plan = compile_plan(protocol, sequences(protocol)[0])
    assert total_s(timeline(protocol, plan, {}, language="fr")) > 120 + 6 * 70
