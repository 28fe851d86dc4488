"""Tests of several inputs at the same instant."""

from app.science.tasks import (
    Command,
    CommandKind,
    Contact,
    ContactChange,
    Laterality,
    TaskRules,
    TaskRun,
    current_goal,
    rederive,
    replay,
)
from tests.science.tasks.vector_files import layout


def test_stepping_on_the_start_square_at_the_completion_is_no_arrival() -> None:
    """A step on the start square must come after the completion, not at the same instant."""
    run = TaskRun(TaskRules(layout("foot"), Laterality.RIGHT), ())
    run.command(CommandKind.START, 0.0)
    for time_s, key in enumerate(("4/panel", "3/panel", "2/panel", "1/panel", "target"), start=1):
        run.apply(ContactChange(float(time_s), (Contact(f"foot/{key}", "RightFoot"),)))
    run.apply(ContactChange(5.0, (Contact("foot/start", "LeftFoot"),)))
    assert (current_goal(run.state), run.state.active) == ("foot/start", False)


def test_a_pause_of_no_length_makes_no_new_touch() -> None:
    """A contact through a pause of zero length stays one contact, live and in the record."""
    rules = TaskRules(layout("hand"), Laterality.RIGHT)
    run = TaskRun(rules, ())
    run.command(CommandKind.START, 0.0)
    run.apply(ContactChange(1.0, (Contact("hand/3/panel", "RightThumbDistal"),)))
    run.apply(ContactChange(2.0, (Contact("hand/4/panel", "RightHand"),)))
    run.command(CommandKind.PAUSE, 3.0)
    run.command(CommandKind.RESUME, 3.0)
    run.command(CommandKind.FREEZE, 4.0)
    commands: list[Command] = run.commands
    state, _ = replay(rules, run.intervals, commands)
    assert (state.n_green, run.state.n_green) == (1, 1)
    assert rederive(rules, run.intervals, commands) == run.summary().completions
