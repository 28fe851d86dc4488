"""The hand and foot box tasks: layout, contacts, rules and summaries.

    layout = build_layout(...)                        the surfaces, the same for every participant
    run = TaskRun(TaskRules(layout, writing_hand), part_names)
    run.command(CommandKind.START, time_s)
    run.frame(time_s, *touching_and_near(SurfaceArrays.of(layout), segments_m, radii_m, margin_m))
    run.state, run.events, run.intervals, run.summary()

`TaskRun` is a convenience around the pure function `advance(state, step)`. The headset implements
the same rules; the test vectors in `tests/vectors/tasks` check both implementations.
"""

from app.science.tasks.clock import ActiveClock, ClockError
from app.science.tasks.contacts import (
    SurfaceArrays,
    segment_box_distance_m,
    touching,
    touching_and_near,
    touching_frames,
)
from app.science.tasks.layout import build_layout
from app.science.tasks.names import Direction, Laterality, Limb, Side, SurfaceKind
from app.science.tasks.rules import advance
from app.science.tasks.run import TaskRun, rederive, replay
from app.science.tasks.state import (
    Command,
    CommandKind,
    Contact,
    ContactChange,
    EventKind,
    TaskEvent,
    TaskRuleError,
    TaskRules,
    TaskState,
)
from app.science.tasks.summaries import (
    Span,
    completions,
    part_side_time_s,
    red_spans,
    side_red_time_s,
    union,
)
from app.science.tasks.surfaces import (
    BlockSpec,
    BoxSpec,
    LayoutError,
    Surface,
    TaskLayout,
    Vector3,
    side_unit,
)
from app.science.tasks.tracker import ContactInterval, ContactTracker
from app.science.tasks.views import current_goal, displayed_numbers, surface_state

__all__ = [
    "ActiveClock",
    "BlockSpec",
    "BoxSpec",
    "ClockError",
    "Command",
    "CommandKind",
    "Contact",
    "ContactChange",
    "ContactInterval",
    "ContactTracker",
    "Direction",
    "EventKind",
    "Laterality",
    "LayoutError",
    "Limb",
    "Side",
    "Span",
    "Surface",
    "SurfaceArrays",
    "SurfaceKind",
    "TaskEvent",
    "TaskLayout",
    "TaskRuleError",
    "TaskRules",
    "TaskRun",
    "TaskState",
    "Vector3",
    "advance",
    "build_layout",
    "completions",
    "current_goal",
    "displayed_numbers",
    "part_side_time_s",
    "red_spans",
    "rederive",
    "replay",
    "segment_box_distance_m",
    "side_red_time_s",
    "side_unit",
    "surface_state",
    "touching",
    "touching_and_near",
    "touching_frames",
    "union",
]
