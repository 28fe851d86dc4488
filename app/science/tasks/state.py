"""The inputs of the task rules, their outputs, and the state of a phase.

Inputs: `Command` (start, pause, resume, freeze) and `ContactChange` (contacts that begin and end at
one instant). Output: `TaskEvent`. All have times in seconds of one monotonic clock. All values are
frozen.
"""

from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property
from typing import NamedTuple

from app.science.tasks.clock import ActiveClock
from app.science.tasks.names import Direction, Laterality, Limb, SurfaceKind, foot_parts, hand_parts
from app.science.tasks.surfaces import TaskLayout


class TaskRuleError(ValueError):
    """An input that is not valid in this state; the message lists what is valid."""


class Contact(NamedTuple):
    """One body part on one surface: (surface key, part name)."""

    surface: str
    part: str


class CommandKind(StrEnum):
    """The commands that control a phase. Freeze ends it."""

    START = "start"
    PAUSE = "pause"
    RESUME = "resume"
    FREEZE = "freeze"


@dataclass(frozen=True)
class Command:
    """A command and the time at which it takes effect (seconds, monotonic)."""

    kind: CommandKind
    time_s: float


@dataclass(frozen=True)
class ContactChange:
    """The contacts that begin and end at one instant (seconds, monotonic)."""

    time_s: float
    begins: tuple[Contact, ...] = ()
    ends: tuple[Contact, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.begins or self.ends)


class EventKind(StrEnum):
    """The kinds of event in a phase. Only PANEL_GREEN and TASK_COMPLETED are progress."""

    STARTED = "started"
    PAUSED = "paused"
    RESUMED = "resumed"
    FROZEN = "frozen"
    PANEL_GREEN = "panel_green"
    TASK_COMPLETED = "task_completed"
    ORDER_REVERSED = "order_reversed"
    OUT_OF_ORDER = "out_of_order"
    WRONG_PART = "wrong_part"
    TARGET_EARLY = "target_early"
    SIDE_RED = "side_red"
    SIDE_WHITE = "side_white"
    WALK_BACK_BEGUN = "walk_back_begun"
    WALK_BACK_ENDED = "walk_back_ended"


@dataclass(frozen=True)
class TaskEvent:
    """Something that happened in a phase, as the rules report it.

    `time_s`: the time on the monotonic clock; `active_s`: the time on the active clock. `task`: the
    running task, 1 for the first (a completion has the number of the task it completes). `surface`,
    `part`: the surface touched and the part touching it; for side_red and side_white the surface is
    the side's unit ("hand/2/left", "hand/2/front_rim") and `part` is the part that turned it red.
    """

    kind: EventKind
    time_s: float
    active_s: float
    task: int
    surface: str | None = None
    part: str | None = None


@dataclass(frozen=True)
class TaskRules:
    """A layout together with a participant's writing hand.

    `writing_hand` determines the direction and, in hand tasks, which parts count.
    """

    layout: TaskLayout
    writing_hand: Laterality

    @cached_property
    def counting_parts(self) -> frozenset[str]:
        """The parts whose touches count: writing hand with fingers, or foot and toes."""
        if self.layout.limb is Limb.HAND:
            return hand_parts(self.writing_hand)
        return foot_parts(self.layout.counting_foot)

    @property
    def first_order(self) -> tuple[int, ...]:
        """Box numbers in the order of the first task."""
        left_to_right = tuple(range(1, self.layout.n_boxes + 1))
        direction = self.layout.direction
        if direction is Direction.BY_HAND:
            starts_left = self.writing_hand is Laterality.LEFT
        else:
            starts_left = direction is Direction.LEFT_TO_RIGHT
        return left_to_right if starts_left else left_to_right[::-1]

    def initial(self) -> "TaskState":
        """Return the state before the start."""
        return TaskState(self, self.first_order)


@dataclass(frozen=True)
class TaskState:
    """The state of a phase, computed from its inputs by `rules.advance`.

    `order`: box numbers in the current order; the first `n_green` of them are green. `completed`:
    the number of completed tasks. `goal_since_s`: the time at which the current goal became
    current. `contacts`: those that exist now, whether or not they count. `walk_back_since_s`: None
    unless walking back. `arrived`: counting feet that have stepped on the start square during this
    walk back and are still on it.
    """

    rules: TaskRules
    order: tuple[int, ...]
    n_green: int = 0
    completed: int = 0
    goal_since_s: float = float("-inf")
    clock: ActiveClock = field(default_factory=ActiveClock)
    contacts: frozenset[Contact] = frozenset()
    paused: bool = False
    walk_back_since_s: float | None = None
    arrived: frozenset[Contact] = frozenset()
    frozen: bool = False
    last_s: float = float("-inf")

    @property
    def started(self) -> bool:
        """Whether the phase has received its start command."""
        return self.clock.last_s is not None

    @property
    def active(self) -> bool:
        """Whether contacts count now: started, and not paused, walking back or frozen."""
        return self.clock.running_since_s is not None

    def red_units(self) -> dict[str, str]:
        """Return the sides that are red now: unit -> alphabetically first part touching it."""
        if not self.active:
            return {}
        red: dict[str, str] = {}
        for contact in self.contacts:
            surface = self.rules.layout.by_key[contact.surface]
            if surface.kind is SurfaceKind.SIDE:
                red[surface.unit] = min(red.get(surface.unit, contact.part), contact.part)
        return red
