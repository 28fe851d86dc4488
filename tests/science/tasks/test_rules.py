"""Tests of the task rules and the record on random phases, and of invalid inputs."""

from collections import Counter
from dataclasses import replace
from itertools import pairwise

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from app.science.tasks import (
    Command,
    CommandKind,
    Contact,
    ContactChange,
    ContactInterval,
    EventKind,
    Laterality,
    TaskEvent,
    TaskRuleError,
    TaskRules,
    TaskRun,
    advance,
    current_goal,
    displayed_numbers,
    part_side_time_s,
    red_spans,
    rederive,
    replay,
    side_red_time_s,
)
from tests.science.tasks.random_runs import LAYOUTS, MOVES, Moves, random_run
from tests.science.tasks.vector_files import layout

NAMES = st.sampled_from(LAYOUTS)
TWO_TASKS: Moves = [(1, "goal", 0, 0)] * 24
CHOSEN_BY_NAME = (EventKind.SIDE_RED, EventKind.SIDE_WHITE, EventKind.WALK_BACK_ENDED)
PROGRESS = (EventKind.PANEL_GREEN, EventKind.TASK_COMPLETED)


def mirrored_name(name: str) -> str:
    """Return a surface key or part name mirrored left to right (four boxes in a row)."""
    words = [str(5 - int(word)) if word.isdigit() else word for word in name.split("/")]
    swap = {"left": "right", "right": "left"}
    name = "/".join(swap.get(word, word) for word in words)
    for one, other in (("Left", "Right"), ("Right", "Left")):
        if name.startswith(one):
            return other + name.removeprefix(one)
    return name


def mirrored(step: ContactChange | Command) -> ContactChange | Command:
    """Return an input mirrored left to right."""
    if isinstance(step, Command):
        return step
    begins, ends = (
        tuple(Contact(mirrored_name(c.surface), mirrored_name(c.part)) for c in contacts)
        for contacts in (step.begins, step.ends)
    )
    return ContactChange(step.time_s, begins, ends)


def comparable(event: TaskEvent) -> tuple[object, ...]:
    """Return an event's values, without a part that is merely the first of several by name."""
    part = None if event.kind in CHOSEN_BY_NAME else event.part
    return (event.kind, event.time_s, event.active_s, event.task, event.surface, part)


def test_random_phases_complete_tasks() -> None:
    """The random moves of these tests do complete hand and foot tasks."""
    for name in LAYOUTS:
        assert len(random_run(name, TWO_TASKS)[0].summary().completions) == 2


@given(NAMES, MOVES)
@example("foot", TWO_TASKS)
@example("hand", TWO_TASKS)
def test_the_record_gives_the_live_completions(name: str, moves: Moves) -> None:
    """Completions derived from the recorded intervals and commands equal those of the live run."""
    run, steps = random_run(name, moves)
    commands = [step for step in steps if isinstance(step, Command)]
    assert run.summary().completions == rederive(run.state.rules, run.intervals, commands)


@given(NAMES, MOVES)
@example("foot", TWO_TASKS)
def test_the_record_gives_the_live_events(name: str, moves: Moves) -> None:
    """Events derived from the record equal those of the live run."""
    run, steps = random_run(name, moves)
    commands = [step for step in steps if isinstance(step, Command)]
    events = replay(run.state.rules, run.intervals, commands)[1]
    keep = (*PROGRESS, EventKind.OUT_OF_ORDER, EventKind.WRONG_PART, EventKind.TARGET_EARLY)
    live = [comparable(event) for event in run.events if event.kind in keep]
    assert live == [comparable(event) for event in events if event.kind in keep]


@given(NAMES, MOVES)
@example("hand", TWO_TASKS)
def test_completions_are_numbered_and_in_order(name: str, moves: Moves) -> None:
    """Completions are numbered in order, their durations add up, and each includes all boxes."""
    run, _ = random_run(name, moves)
    done = run.summary().completions
    assert [c.number for c in done] == list(range(1, len(done) + 1))
    assert all(a.completed_s < b.completed_s for a, b in pairwise(done))
    assert sum(c.duration_s for c in done) == (done[-1].completed_active_s if done else 0.0)
    assert all(len(set(c.order)) == len(c.order) == 4 for c in done)


@given(NAMES, MOVES)
def test_a_side_is_red_no_longer_than_its_parts_touch_it(name: str, moves: Moves) -> None:
    """A side's red time is at least its longest part's contact and at most the sum of all."""
    run, _ = random_run(name, moves)
    parts = part_side_time_s(run.intervals)
    for side, red_s in side_red_time_s(run.intervals).items():
        own = [time_s for (touched, _), time_s in parts.items() if touched == side]
        assert max(own) <= red_s <= sum(own)


@given(NAMES, MOVES)
def test_red_time_of_the_record_is_what_was_shown(name: str, moves: Moves) -> None:
    """The union of intervals equals the time between the events that turn a side red and white."""
    run, _ = random_run(name, moves)
    shown: Counter[str] = Counter()
    for event in run.events:
        sign = {EventKind.SIDE_RED: -1, EventKind.SIDE_WHITE: 1}.get(event.kind)
        if sign is not None:
            shown[str(event.surface)] += int(4 * sign * event.active_s)
    expected = {side: time_s for side, time_s in side_red_time_s(run.intervals).items() if time_s}
    assert expected == {side: quarters / 4 for side, quarters in shown.items() if quarters}


@given(NAMES, MOVES)
def test_intervals_contain_active_time_only(name: str, moves: Moves) -> None:
    """Every interval is as long on the active clock as on the wall clock, and within the phase."""
    run, steps = random_run(name, moves)
    for interval in run.intervals:
        length_s = interval.end_s - interval.begin_s
        assert length_s == interval.end_active_s - interval.begin_active_s >= 0.0
        assert 0.0 <= interval.begin_s <= interval.end_s <= steps[-1].time_s


@given(st.permutations([("RightHand", 1.0, 3.0), ("LeftHand", 2.0, 5.0), ("Head", 5.0, 6.0)]))
def test_the_order_of_parts_does_not_change_the_union(
    parts: list[tuple[str, float, float]],
) -> None:
    """The red time of a side does not depend on the order of its intervals."""
    intervals = [ContactInterval("hand/1/left", p, b, e, b, e) for p, b, e in parts]
    assert red_spans(intervals) == {"hand/1/left": ((1.0, 6.0),)}


@given(MOVES, st.permutations(["RightHand", "RightIndexDistal", "RightThumbDistal", "LeftHand"]))
def test_simultaneous_contacts_have_no_order(moves: Moves, parts: list[str]) -> None:
    """Contacts of one instant may be listed in any order."""
    run, _ = random_run("hand", moves[:10])
    state = replace(run.state, frozen=False)
    if not state.active:
        state = replace(state, clock=state.clock.resume(state.last_s), paused=False)
    contacts = [Contact(key, p) for key in ("hand/2/left", "hand/3/panel") for p in sorted(parts)]
    shuffled = [Contact(key, p) for p in parts for key in ("hand/3/panel", "hand/2/left")]
    time_s = state.last_s + 1.0
    expected = advance(state, ContactChange(time_s, tuple(contacts)))
    assert expected == advance(state, ContactChange(time_s, tuple(shuffled)))


@given(st.sampled_from(["hand", "foot", "foot_reversing"]), MOVES)
@example("hand", TWO_TASKS)
def test_a_mirrored_left_hander_does_the_same(name: str, moves: Moves) -> None:
    """Mirroring the contacts and swapping the hand mirrors every event."""
    run, steps = random_run(name, moves)
    mirror = TaskRun(TaskRules(layout(name), Laterality.LEFT), ())
    for step in steps:
        mirror.apply(mirrored(step))
    expected = Counter(comparable(event) for event in run.events)
    swapped = [
        replace(
            e, surface=e.surface and mirrored_name(e.surface), part=e.part and mirrored_name(e.part)
        )
        for e in mirror.events
    ]
    assert expected == Counter(comparable(event) for event in swapped)


@given(NAMES, MOVES)
def test_the_goal_carries_the_lowest_number_that_is_not_green(name: str, moves: Moves) -> None:
    """The box numbers are a permutation, and the goal has the lowest that is not green."""
    run, _ = random_run(name, moves)
    state = replace(run.state, frozen=False, walk_back_since_s=None)
    numbers = displayed_numbers(state)
    assert sorted(numbers.values()) == [1, 2, 3, 4]
    box = next((box for box, number in numbers.items() if number == state.n_green + 1), None)
    expected = state.rules.layout.target_key if box is None else state.rules.layout.panel_key(box)
    assert expected == current_goal(state)


def test_unknown_surfaces_are_rejected() -> None:
    """An unknown surface raises an error that lists the valid ones."""
    state = TaskRules(layout("hand"), Laterality.RIGHT).initial()
    with pytest.raises(TaskRuleError, match=r"no surface 'hand/9/panel'. Use one of: hand/1/panel"):
        advance(state, ContactChange(0.0, (Contact("hand/9/panel", "RightHand"),)))


@pytest.mark.parametrize("time_s", [0.5, float("nan"), float("inf")])
def test_times_that_go_back_are_rejected(time_s: float) -> None:
    """A time that goes back or is not a number raises an error and leaves the run unchanged."""
    run = TaskRun(TaskRules(layout("hand"), Laterality.RIGHT), ())
    run.command(CommandKind.START, 1.0)
    before = run.state
    with pytest.raises(TaskRuleError, match=r"Time went from 1.0 s to"):
        run.command(CommandKind.PAUSE, time_s)
    assert (run.state, len(run.commands)) == (before, 1)


def test_a_contact_cannot_begin_and_end_in_one_change() -> None:
    """A contact that begins and ends in one change is rejected by name."""
    state = TaskRules(layout("hand"), Laterality.RIGHT).initial()
    contact = Contact("hand/target", "Head")
    with pytest.raises(TaskRuleError, match="Give two changes instead"):
        advance(state, ContactChange(0.0, (contact,), (contact,)))
