"""Run a phase from frames and commands, and replay it from its record.

`TaskRun` keeps contacts, rules, intervals and summary in one place. `rederive` replays a phase from
its record, to check that the stored completions are what happened.

The record is the contact intervals and the commands. Walk backs are not recorded: they follow from
the completions. Intervals exist only where contacts counted, which determines the order of inputs
at one instant: if the clock could be running before it, the contacts counted, so they precede the
commands; if the phase was not started or paused, the commands precede them.

Intervals leave one case open: whether a contact that begins in a pause of length zero began before
or after it. It is taken to have begun before.
"""

from collections import defaultdict
from collections.abc import Iterable

from app.science.tasks.contacts import Bools
from app.science.tasks.rules import advance
from app.science.tasks.state import (
    Command,
    CommandKind,
    Contact,
    ContactChange,
    TaskEvent,
    TaskRules,
    TaskState,
)
from app.science.tasks.summaries import Completion, PhaseSummary, completions, summarise
from app.science.tasks.tracker import ContactInterval, ContactTracker


class TaskRun:
    """Applies the rules to one phase, input by input, and keeps its record.

    `state`: the present TaskState; `events`, `intervals`, `commands`: everything so far. Inputs
    must come in order of time; a rejected input (TaskRuleError) changes nothing.
    """

    def __init__(self, rules: TaskRules, parts: tuple[str, ...]) -> None:
        surfaces = tuple(surface.key for surface in rules.layout.surfaces)
        self.state = rules.initial()
        self.events: list[TaskEvent] = []
        self.intervals: list[ContactInterval] = []
        self.commands: list[Command] = []
        self._tracker = ContactTracker(surfaces, parts)

    def command(self, kind: CommandKind, time_s: float) -> tuple[TaskEvent, ...]:
        """Apply a command (start, pause, resume or freeze) and return the resulting events."""
        command = Command(kind, time_s)
        events = self.apply(command)
        self.commands.append(command)
        return events

    def frame(
        self, time_s: float, touching: Bools, near: Bools | None = None
    ) -> tuple[TaskEvent, ...]:
        """Apply the contacts of one frame and return the resulting events.

        `touching`, `near`: (S, P) as `contacts.touching_and_near` returns them.
        """
        change = self._tracker.observe(time_s, touching, near)
        return self.apply(change) if change else ()

    def apply(self, step: ContactChange | Command) -> tuple[TaskEvent, ...]:
        """Apply one input of the rules and return the resulting events."""
        self.state, events = advance(self.state, step)
        self.intervals += self._tracker.settle(self.state)
        self.events += events
        return events

    def summary(self) -> PhaseSummary:
        """Summarise the phase so far, from the intervals that have been closed."""
        return summarise(self.events, self.intervals)


_Step = ContactChange | Command


def rederive(
    rules: TaskRules,
    intervals: Iterable[ContactInterval],
    commands: Iterable[Command],
    *,
    initial: TaskState | None = None,
) -> tuple[Completion, ...]:
    """Return the completions that follow from stored intervals and commands (in the order given).

    `initial` is the state from which to start, for a run that continues another; by default the
    initial state of the rules. Raises TaskRuleError if the record contradicts itself.
    """
    return completions(replay(rules, intervals, commands, initial=initial)[1])


def replay(
    rules: TaskRules,
    intervals: Iterable[ContactInterval],
    commands: Iterable[Command],
    *,
    initial: TaskState | None = None,
) -> tuple[TaskState, tuple[TaskEvent, ...]]:
    """Return the final state and all events that follow from stored intervals and commands.

    Raises TaskRuleError if the record contradicts itself.
    """
    contacts = _changes(intervals)
    commands_at: dict[float, list[_Step]] = defaultdict(list)
    for command in commands:
        commands_at[command.time_s].append(command)
    state = initial or rules.initial()
    events: list[TaskEvent] = []
    for time_s in sorted(contacts.keys() | commands_at.keys()):
        counted = state.started and not state.paused
        first, second = contacts.get(time_s, []), commands_at.get(time_s, [])
        for step in (first + second) if counted else (second + first):
            state, found = advance(state, step)
            events += found
    return state, tuple(events)


def _changes(intervals: Iterable[ContactInterval]) -> dict[float, list[_Step]]:
    """Return the contact changes at each instant; adjoining intervals are one contact."""
    begins: dict[float, set[Contact]] = defaultdict(set)
    ends: dict[float, set[Contact]] = defaultdict(set)
    instants: dict[float, set[Contact]] = defaultdict(set)
    lasting: dict[float, set[Contact]] = defaultdict(set)
    for interval in intervals:
        contact = Contact(interval.surface, interval.part)
        begins[interval.begin_s].add(contact)
        if interval.end_s > interval.begin_s:
            ends[interval.end_s].add(contact)
            lasting[interval.begin_s].add(contact)
        else:
            instants[interval.end_s].add(contact)
    steps: dict[float, list[_Step]] = {}
    for time_s in begins.keys() | ends.keys():
        new, ended = begins[time_s] - ends[time_s], ends[time_s] - begins[time_s]
        momentary = instants[time_s] - lasting[time_s]
        steps[time_s] = [ContactChange(time_s, tuple(sorted(new)), tuple(sorted(ended)))]
        if momentary:
            steps[time_s].append(ContactChange(time_s, (), tuple(sorted(momentary))))
    return steps
