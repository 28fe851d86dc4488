"""Random phases that make progress: hypothesis draws moves, which depend on the state."""

from hypothesis import strategies as st

from app.science.tasks import (
    Command,
    CommandKind,
    Contact,
    ContactChange,
    Laterality,
    TaskRules,
    TaskRun,
    current_goal,
)
from tests.science.tasks.vector_files import layout

# Few parts and surfaces, so that contacts meet and overlap often.
_PARTS = {
    "hand": ("RightHand", "LeftHand", "RightIndexDistal", "RightLowerArm"),
    "foot": ("RightFoot", "LeftFoot", "LeftToes", "RightLowerLeg"),
}
_PLACES = {
    "hand": ("4/panel", "3/panel", "target", "2/left", "2/top", "1/right"),
    "foot": ("4/panel", "3/panel", "target", "start", "2/left", "2/front"),
}
LAYOUTS = ("hand", "hand_rim", "foot", "foot_reversing", "foot_right")

# (quarter seconds since the previous move, what, which surface, which part)
MOVES = st.lists(
    st.tuples(
        st.integers(0, 4),
        st.sampled_from(["goal", "goal", "goal", "toggle", "toggle", "clock"]),
        st.integers(0, 5),
        st.integers(0, 3),
    ),
    max_size=60,
)
Moves = list[tuple[int, str, int, int]]
Steps = list[ContactChange | Command]


def random_run(name: str, moves: Moves) -> tuple[TaskRun, Steps]:
    """Return a right-handed phase on a layout, frozen at the end, and its inputs."""
    run = TaskRun(TaskRules(layout(name), Laterality.RIGHT), ())
    steps: Steps = [Command(CommandKind.START, 0.0)]
    run.apply(steps[0])
    time_s = changed_s = paused_s = 0.0
    for quarters, what, place, part in moves:
        time_s += quarters / 4
        if what == "clock":
            kind = CommandKind.RESUME if run.state.paused else CommandKind.PAUSE
            # A record needs pauses of some length and at most one change an instant.
            time_s = max(time_s, paused_s + 0.25) if run.state.paused else time_s
            paused_s = time_s
            steps.append(Command(kind, time_s))
        else:
            time_s = max(time_s, changed_s + 0.25)
            changed_s = time_s
            steps.append(_change(run, time_s, what, place, part))
        run.apply(steps[-1])
    steps.append(Command(CommandKind.FREEZE, time_s))
    run.apply(steps[-1])
    return run, steps


def _change(run: TaskRun, time_s: float, what: str, place: int, part: int) -> ContactChange:
    """Return a change that begins or ends the first part's contact with the goal or any contact."""
    limb = run.state.rules.layout.limb.value
    goal = current_goal(run.state)
    contact = Contact(f"{limb}/{_PLACES[limb][place]}", _PARTS[limb][part])
    if what == "goal" and goal is not None:
        contact = Contact(goal, _PARTS[limb][0])
    if contact in run.state.contacts:
        return ContactChange(time_s, (), (contact,))
    return ContactChange(time_s, (contact,), ())
