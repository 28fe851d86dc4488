"""Tests of the movement goals that a scripted participant derives from the task rules."""

from app.science.simulation import GoalKind
from app.science.tasks import (
    Command,
    CommandKind,
    Contact,
    ContactChange,
    Laterality,
    TaskRules,
    TaskState,
    advance,
)
from app.simulated_people.goals import goal_of
from tests.protocol.helpers import study

RIGHT = Laterality.RIGHT


def started(limb: str) -> TaskState:
    """Return a task of the shipped study with its clock running."""
    tasks = study().tasks
    layout = tasks.layout(limb)
    state, _ = advance(TaskRules(layout, RIGHT).initial(), Command(CommandKind.START, 0.0))
    return state


def touched(state: TaskState, surface: str, part: str) -> TaskState:
    """Return the task's state after a short touch."""
    contact = Contact(surface, part)
    state, _ = advance(state, ContactChange(state.last_s + 0.1, begins=(contact,)))
    state, _ = advance(state, ContactChange(state.last_s + 0.1, ends=(contact,)))
    return state


def test_the_writing_hand_reaches_for_the_face_of_the_current_panel() -> None:
    """A right-handed participant reaches with the right hand, first for the rightmost panel."""
    state = started("hand")
    goal = goal_of(state, RIGHT)
    panel = state.rules.layout.by_key["hand/4/panel"]
    assert goal is not None
    assert (goal.kind, goal.effector) == (GoalKind.REACH, "RightHand")
    assert goal.target_m is not None
    assert goal.target_m[:2] == panel.center_m[:2]
    assert goal.target_m[2] == panel.center_m[2] + panel.half_size_m[2]


def test_feet_alternate_from_box_to_box() -> None:
    """In a foot task the participant steps on successive boxes with alternating feet."""
    state = started("foot")
    first = goal_of(state, RIGHT)
    second = goal_of(touched(state, "foot/4/panel", "RightFoot"), RIGHT)
    assert first is not None
    assert second is not None
    assert (first.effector, second.effector) == ("RightFoot", "LeftFoot")


def test_after_the_bar_the_participant_walks_to_the_start_square() -> None:
    """After the bar of a foot task, the goal is to walk to the start square."""
    state = started("foot")
    for number in (4, 3, 2, 1):
        state = touched(state, f"foot/{number}/panel", "RightFoot")
    goal = goal_of(touched(state, "foot/target", "RightFoot"), RIGHT)
    assert goal is not None
    assert goal.kind is GoalKind.WALK_TO
    assert goal.target_m is not None
    assert (goal.target_m[0], goal.target_m[2]) == (0.0, 0.0)


def test_a_frozen_phase_has_no_goal() -> None:
    """A phase in its freeze has no goal."""
    state, _ = advance(started("hand"), Command(CommandKind.FREEZE, 1.0))
    assert goal_of(state, RIGHT) is None
