"""The order of a factor's levels: as declared, numeric if all are numbers, else natural sort order.

Trends and "the first level that differs" depend on the order, and it must not depend on the order
of rows in a file. "0", "125" and "350" are ordered as numbers; "2 ms" comes before "10 ms". Names
have no order of their own: sorting them only makes tables readable, and a trend over them means
nothing unless their order was declared (`has_order`).
"""

import math
import re
from collections.abc import Iterable, Sequence

from app.science.statistics.errors import StatisticsError

_DIGITS = re.compile(r"(\d+)")


def ordered_levels(found: Iterable[str]) -> tuple[str, ...]:
    """Return the distinct levels in order.

    If all are numbers, different spellings of one number ("0" and "0.0") are one level, which has
    its shortest spelling.
    """
    different = sorted(set(found))
    numbers = [as_number(level) for level in different]
    if not any(number is None for number in numbers):
        spelled: dict[float, str] = {}
        for number, level in zip(numbers, different, strict=True):
            if number is not None:
                shortest = spelled.get(number, level)
                spelled[number] = min(shortest, level, key=lambda text: (len(text), text))
        return tuple(spelled[number] for number in sorted(spelled))
    return tuple(sorted(different, key=_natural))


def has_order(levels: Sequence[str]) -> bool:
    """Return whether the levels have an order of their own, because all are numbers."""
    return not any(as_number(level) is None for level in levels)


def declared_levels(factor: str, found: Iterable[str], declared: Sequence[str]) -> tuple[str, ...]:
    """Return the levels of a factor in their declared order.

    Raises StatisticsError if it does not name every level exactly once.
    """
    levels = ordered_levels(found)
    if len(declared) == len(levels):
        places = {place_of(levels, level) for level in declared}
        if len(places) == len(levels):
            return tuple(levels[place_of(levels, level)] for level in declared)
    raise StatisticsError(
        f"The order of {factor!r} names {', '.join(declared)}; name each of its"
        f" {len(levels)} levels once: {', '.join(levels)}."
    )


def level_places(levels: Sequence[str]) -> dict[object, int]:
    """Return the place of each level by its spelling and, for numbers, by its value too."""
    places: dict[object, int] = {level: place for place, level in enumerate(levels)}
    numbers = [as_number(level) for level in levels]
    if not any(number is None for number in numbers):
        places.update({number: place for place, number in enumerate(numbers)})
    return places


def place_of(levels: Sequence[str], level: str) -> int:
    """Return the place of one level; raises StatisticsError, listing the levels, if unknown."""
    places = level_places(levels)
    place = places.get(level, places.get(as_number(level)))
    if place is None:
        raise StatisticsError(f"There is no level {level!r}; there are: {', '.join(levels)}.")
    return place


def as_number(text: str) -> float | None:
    """Parse a text as a finite number; None if it is not one."""
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(number) and "_" not in text else None


def _natural(level: str) -> tuple[list[tuple[int, float, str]], str]:
    pieces = _DIGITS.split(level.casefold())
    key = [
        (0, float(piece), "") if piece.isdigit() else (1, 0.0, piece) for piece in pieces if piece
    ]
    return key, level
