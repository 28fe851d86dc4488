"""When the sides of boxes were red, from the contacts of all body parts."""

from collections.abc import Iterable

from app.science.tasks import Span, side_unit, union


def red_spans(contacts: Iterable[tuple[str, float, float]]) -> dict[str, tuple[Span, ...]]:
    """Spans in which each side was red, such as "hand/2/left": the union over body parts.

    `contacts` are (surface, begin_active_s, end_active_s) of one phase; the bars of a rim are one
    side.
    """
    by_side: dict[str, list[Span]] = {}
    for surface, begin_s, end_s in contacts:
        by_side.setdefault(side_unit(surface) or surface, []).append((begin_s, end_s))
    return {side: union(spans) for side, spans in by_side.items()}


def total_s(spans: Iterable[Span]) -> float:
    """Length of disjoint spans together, in s."""
    return sum((end - begin for begin, end in spans), 0.0)
