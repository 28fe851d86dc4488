"""The results of a phase: completed tasks, mistakes, and how long each side was red.

A side is red while at least one part touches it, so its red time is the *union* of its parts'
intervals. The times of single parts overlap, so their sum is not the red time.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

from app.science.tasks.state import EventKind, TaskEvent
from app.science.tasks.surfaces import side_unit
from app.science.tasks.tracker import ContactInterval

Span = tuple[float, float]


@dataclass(frozen=True)
class Completion:
    """One completed task of a phase.

    `number`: the number of the task, 1 for the first. `completed_s`, `completed_active_s`: the time
    of completion on the monotonic clock and on the active clock. `duration_s`: active time since
    the previous completion, or since the start. `order`: panel keys as they were touched. The
    counts are the mistakes made during this task.
    """

    number: int
    completed_s: float
    completed_active_s: float
    duration_s: float
    order: tuple[str, ...]
    out_of_order: int = 0
    wrong_part: int = 0
    target_early: int = 0


@dataclass(frozen=True)
class PhaseSummary:
    """The results of a whole phase; the counts of mistakes include the unfinished last task.

    `side_contacts`: the number of times that a side turned red; a pause does not split a contact.
    Times are in active seconds.
    """

    completions: tuple[Completion, ...]
    out_of_order: int
    wrong_part: int
    target_early: int
    side_contacts: int
    side_red_time_s: dict[str, float]
    part_side_time_s: dict[tuple[str, str], float]

    @property
    def side_contact_s(self) -> float:
        """Red time summed over the sides (two sides red simultaneously count twice)."""
        return sum(self.side_red_time_s.values())


def red_spans(intervals: Iterable[ContactInterval]) -> dict[str, tuple[Span, ...]]:
    """Return when each touched side was red: side -> disjoint spans in order, in active seconds."""
    by_side: dict[str, list[Span]] = {}
    for interval in intervals:
        side = side_unit(interval.surface)
        if side is not None:
            by_side.setdefault(side, []).append((interval.begin_active_s, interval.end_active_s))
    return {side: union(spans) for side, spans in sorted(by_side.items())}


def side_red_time_s(intervals: Iterable[ContactInterval]) -> dict[str, float]:
    """Return how many active seconds each touched side was red: the union over its parts."""
    return {side: _length(spans) for side, spans in red_spans(intervals).items()}


def part_side_time_s(intervals: Iterable[ContactInterval]) -> dict[tuple[str, str], float]:
    """Return how long each part touched each side: (side, part) -> seconds of the active clock.

    The times of different parts overlap.
    """
    by_part: dict[str, list[ContactInterval]] = {}
    for interval in intervals:
        by_part.setdefault(interval.part, []).append(interval)
    return {
        (side, part): time_s
        for part, own in sorted(by_part.items())
        for side, time_s in side_red_time_s(own).items()
    }


def union(spans: Iterable[Span]) -> tuple[Span, ...]:
    """Merge spans that overlap or adjoin; return disjoint spans in order."""
    merged: list[Span] = []
    for begin, end in sorted(spans):
        if merged and begin <= merged[-1][1]:
            merged[-1] = merged[-1][0], max(merged[-1][1], end)
        else:
            merged.append((begin, end))
    return tuple(merged)


def completions(events: Iterable[TaskEvent]) -> tuple[Completion, ...]:
    """Return the completed tasks of a phase, in order."""
    found: list[Completion] = []
    task = Completion(1, 0.0, 0.0, 0.0, ())
    for event in events:
        if event.kind is EventKind.PANEL_GREEN and event.surface is not None:
            task = replace(task, order=(*task.order, event.surface))
        elif event.kind is EventKind.OUT_OF_ORDER:
            task = replace(task, out_of_order=task.out_of_order + 1)
        elif event.kind is EventKind.WRONG_PART:
            task = replace(task, wrong_part=task.wrong_part + 1)
        elif event.kind is EventKind.TARGET_EARLY:
            task = replace(task, target_early=task.target_early + 1)
        elif event.kind is EventKind.TASK_COMPLETED:
            found.append(_finish(task, event, found))
            task = Completion(len(found) + 1, 0.0, 0.0, 0.0, ())
    return tuple(found)


def summarise(events: Iterable[TaskEvent], intervals: Iterable[ContactInterval]) -> PhaseSummary:
    """Summarise a phase from its events and its closed intervals."""
    events, intervals = tuple(events), tuple(intervals)
    kinds = [event.kind for event in events]
    return PhaseSummary(
        completions=completions(events),
        out_of_order=kinds.count(EventKind.OUT_OF_ORDER),
        wrong_part=kinds.count(EventKind.WRONG_PART),
        target_early=kinds.count(EventKind.TARGET_EARLY),
        side_contacts=sum(len(spans) for spans in red_spans(intervals).values()),
        side_red_time_s=side_red_time_s(intervals),
        part_side_time_s=part_side_time_s(intervals),
    )


def _finish(task: Completion, event: TaskEvent, earlier: list[Completion]) -> Completion:
    since_s = earlier[-1].completed_active_s if earlier else 0.0
    return replace(
        task,
        completed_s=event.time_s,
        completed_active_s=event.active_s,
        duration_s=event.active_s - since_s,
    )


def _length(spans: tuple[Span, ...]) -> float:
    return sum((end - begin for begin, end in spans), 0.0)
