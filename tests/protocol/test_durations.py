"""The dry run of a visit: what the study sets is exact, what is estimated says so."""

from itertools import pairwise

import pytest

from app.protocol import compile_plan, sequences
from app.protocol.durations import ITEM_S, OPENING_S, form_s, timeline, total_s
from tests.protocol.helpers import instruments, study


def test_the_shipped_study_sets_nine_minutes() -> None:
    """Free movement 120 s and six tasks of 5 + 60 + 5 s (Karas 2020, chapter 7.1)."""
    protocol = study()
    plan = compile_plan(protocol, sequences(protocol)[0])
    steps = timeline(protocol, plan, instruments(), language="en")
    assert sum(step.length_s for step in steps if not step.estimated) == 120 + 6 * 70
    assert {step.step.kind for step in steps if not step.estimated} == {"free_roam", "task"}


def test_steps_follow_one_another() -> None:
    """Each begins when the one before ends, and the total is the end of the last."""
    protocol = study()
    plan = compile_plan(protocol, sequences(protocol)[3])
    steps = timeline(protocol, plan, instruments(), language="de")
    for one, other in pairwise(steps):
        assert other.start_s == pytest.approx(one.start_s + one.length_s)
    assert total_s(steps) == pytest.approx(steps[-1].start_s + steps[-1].length_s)


def test_a_form_takes_its_items() -> None:
    """The simulator sickness questionnaire has 16 rated items."""
    assert form_s(instruments()["ssq"]) == OPENING_S + 16 * ITEM_S["likert"]


def test_an_unknown_instrument_and_language_do_not_stop_it() -> None:
    """An estimate is rough, never an error."""
    protocol = study()
    plan = compile_plan(protocol, sequences(protocol)[0])
    assert total_s(timeline(protocol, plan, {}, language="fr")) > 120 + 6 * 70
