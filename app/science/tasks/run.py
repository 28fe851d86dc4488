"""A phase from frames and commands: contacts, rules, intervals and summary in one place."""

from app.science.tasks.contacts import Bools
from app.science.tasks.rules import advance
from app.science.tasks.state import Command, CommandKind, ContactChange, TaskEvent, TaskRules
from app.science.tasks.summaries import PhaseSummary, summarise
from app.science.tasks.tracker import ContactInterval, ContactTracker


class TaskRun:
    """Feeds one phase to the rules and keeps its record.

    `state`: the present TaskState; `events`, `intervals`, `commands`: everything so far. Inputs
    must come in order of time; an input that is refused (TaskRuleError) changes nothing.
    """

    def __init__(self, rules: TaskRules, parts: tuple[str, ...]) -> None:
        surfaces = tuple(surface.key for surface in rules.layout.surfaces)
        self.state = rules.initial()
        self.events: list[TaskEvent] = []
        self.intervals: list[ContactInterval] = []
        self.commands: list[Command] = []
        self._tracker = ContactTracker(surfaces, parts)

    def command(self, kind: CommandKind, time_s: float) -> tuple[TaskEvent, ...]:
        """Start, pause, resume or freeze; what happened."""
        command = Command(kind, time_s)
        events = self.apply(command)
        self.commands.append(command)
        return events

    def frame(
        self, time_s: float, touching: Bools, near: Bools | None = None
    ) -> tuple[TaskEvent, ...]:
        """The touches of one frame, (S, P) as from `contacts.touching_and_near`; what happened."""
        change = self._tracker.observe(time_s, touching, near)
        return self.apply(change) if change else ()

    def apply(self, step: ContactChange | Command) -> tuple[TaskEvent, ...]:
        """One input of the rules; what happened."""
        self.state, events = advance(self.state, step)
        self.intervals += self._tracker.settle(self.state)
        self.events += events
        return events

    def summary(self) -> PhaseSummary:
        """What the phase comes to so far, over the intervals that have closed."""
        return summarise(self.events, self.intervals)
