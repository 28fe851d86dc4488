"""Tests that frames become contact changes with hysteresis, and rejected frames none."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.science.tasks import (
    CommandKind,
    Contact,
    ContactChange,
    ContactTracker,
    Laterality,
    TaskRuleError,
    TaskRules,
    TaskRun,
)
from app.science.tasks.contacts import Bools
from tests.science.tasks.vector_files import layout

PLACE = layout("hand")
KEYS = tuple(surface.key for surface in PLACE.surfaces)
PARTS = ("RightHand", "LeftHand")


def table(*contacts: tuple[str, str]) -> Bools:
    """Return an (S, P) table with these contacts."""
    touches = np.zeros((len(KEYS), len(PARTS)), dtype=np.bool_)
    for surface, part in contacts:
        touches[KEYS.index(surface), PARTS.index(part)] = True
    return touches


def started() -> TaskRun:
    """Return a run that starts at 0 s."""
    run = TaskRun(TaskRules(PLACE, Laterality.RIGHT), PARTS)
    run.command(CommandKind.START, 0.0)
    return run


@given(st.lists(st.booleans(), min_size=1, max_size=40), st.integers(0, 2**16))
def test_a_margin_only_joins_contacts(touches: list[bool], seed: int) -> None:
    """A margin never gives more intervals, and each raw contact lies within one."""
    near = np.random.default_rng(seed).random(len(touches)) < 0.5
    raw, with_margin = started(), started()
    for index, touch in enumerate(touches):
        now = table(("hand/1/left", "RightHand")) if touch else table()
        raw.frame(index + 1.0, now)
        with_margin.frame(
            index + 1.0, now, now | (table(("hand/1/left", "RightHand")) & near[index])
        )
    for run in (raw, with_margin):
        run.command(CommandKind.FREEZE, 100.0)
    assert len(with_margin.intervals) <= len(raw.intervals)
    for short in raw.intervals:
        assert any(
            i.begin_s <= short.begin_s and short.end_s <= i.end_s for i in with_margin.intervals
        )


def test_near_alone_begins_nothing() -> None:
    """Being within the margin prolongs a contact but never begins one."""
    run = started()
    run.frame(1.0, table(), table(("hand/1/left", "RightHand")))
    assert run.state.contacts == frozenset()


def test_changes_name_surface_and_part() -> None:
    """A change lists the contacts that begin and those that end, by surface and part."""
    tracker = ContactTracker(KEYS, PARTS)
    state = TaskRules(PLACE, Laterality.RIGHT).initial()
    change = tracker.observe(1.0, table(("hand/1/left", "RightHand")))
    assert change == ContactChange(1.0, (Contact("hand/1/left", "RightHand"),), ())
    tracker.settle(state)
    change = tracker.observe(2.0, table(("hand/target", "LeftHand")))
    assert change.begins == (Contact("hand/target", "LeftHand"),)
    assert change.ends == (Contact("hand/1/left", "RightHand"),)


def test_a_rejected_frame_changes_nothing() -> None:
    """After a rejected frame from the past the same contact can still begin."""
    run = started()
    run.frame(2.0, table(("hand/1/left", "LeftHand")))
    both = table(("hand/1/left", "LeftHand"), ("hand/4/panel", "RightHand"))
    with pytest.raises(TaskRuleError):
        run.frame(1.0, both)
    events = run.frame(3.0, both)
    assert [event.surface for event in events] == ["hand/4/panel"]


def test_tables_of_another_shape_are_rejected() -> None:
    """A table of another shape raises an error that states the expected and the given shape."""
    with pytest.raises(ValueError, match=r"Expected near of shape \(21, 2\).*got \(2, 21\)"):
        ContactTracker(KEYS, PARTS).observe(0.0, table(), table().T)
