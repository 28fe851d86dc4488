"""Play a phase again from its record, to check that the stored completions are what happened.

The record is the contact intervals and the commands. Walk backs are not recorded: they follow from
the completions. Intervals exist only where contacts counted, which decides what comes first at
one instant: if the clock could be running before it, the contacts counted, so they precede the
commands; if the phase was not started or paused, the commands precede them.

One thing no interval can tell: whether a contact that begins in a pause of length zero began before
or after it. It is taken to have begun before.
"""

from collections import defaultdict
from collections.abc import Iterable

from app.science.tasks.rules import advance
from app.science.tasks.state import Command, Contact, ContactChange, TaskEvent, TaskRules, TaskState
from app.science.tasks.summaries import Completion, completions
from app.science.tasks.tracker import ContactInterval

_Step = ContactChange | Command


def rederive(
    rules: TaskRules,
    intervals: Iterable[ContactInterval],
    commands: Iterable[Command],
    *,
    initial: TaskState | None = None,
) -> tuple[Completion, ...]:
    """The completions that follow from stored intervals and commands (in the order given).

    `initial` is for a run that began where another had stopped; by default the rules' own. Raises
    TaskRuleError where the record contradicts itself.
    """
    return completions(replay(rules, intervals, commands, initial=initial)[1])


def replay(
    rules: TaskRules,
    intervals: Iterable[ContactInterval],
    commands: Iterable[Command],
    *,
    initial: TaskState | None = None,
) -> tuple[TaskState, tuple[TaskEvent, ...]]:
    """Final state and all events that follow from stored intervals and commands.

    Raises TaskRuleError where the record contradicts itself.
    """
    contacts = _changes(intervals)
    told: dict[float, list[_Step]] = defaultdict(list)
    for command in commands:
        told[command.time_s].append(command)
    state = initial or rules.initial()
    events: list[TaskEvent] = []
    for time_s in sorted(contacts.keys() | told.keys()):
        counted = state.started and not state.paused
        first, second = contacts.get(time_s, []), told.get(time_s, [])
        for step in (first + second) if counted else (second + first):
            state, found = advance(state, step)
            events += found
    return state, tuple(events)


def _changes(intervals: Iterable[ContactInterval]) -> dict[float, list[_Step]]:
    """The contact changes at each instant; intervals that meet are one contact."""
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
        new, gone = begins[time_s] - ends[time_s], ends[time_s] - begins[time_s]
        brief = instants[time_s] - lasting[time_s]
        steps[time_s] = [ContactChange(time_s, tuple(sorted(new)), tuple(sorted(gone)))]
        if brief:
            steps[time_s].append(ContactChange(time_s, (), tuple(sorted(brief))))
    return steps
