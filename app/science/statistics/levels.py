"""The order of a factor's levels: by number where all are numbers, else as people would sort.

Trends and "the first level that differs" depend on the order, and it must not depend on the order
of rows in a file. "0", "125" and "350" are ordered as numbers; "2 ms" comes before "10 ms".
"""

import math
import re
from collections.abc import Iterable, Sequence

from app.science.statistics.errors import StatisticsError

_DIGITS = re.compile(r"(\d+)")


def ordered_levels(found: Iterable[str]) -> tuple[str, ...]:
    """Return the different levels in order.

    Where all are numbers, different spellings of one number ("0" and "0.0") are one level, by its
    shortest spelling.
    """
    different = sorted(set(found))
    numbers = [as_number(level) for level in different]
    if not any(number is None for number in numbers):
        spelled: dict[float, str] = {}
        for number, level in zip(numbers, different, strict=True):
            if number is not None:
                known = spelled.get(number, level)
                spelled[number] = min(known, level, key=lambda one: (len(one), one))
        return tuple(spelled[number] for number in sorted(spelled))
    return tuple(sorted(different, key=_natural))


def level_places(levels: Sequence[str]) -> dict[object, int]:
    """Return the place of each level, by its spelling and, of a number, by its value too."""
    places: dict[object, int] = {level: place for place, level in enumerate(levels)}
    numbers = [as_number(level) for level in levels]
    if not any(number is None for number in numbers):
        places.update({number: place for place, number in enumerate(numbers)})
    return places


def place_of(levels: Sequence[str], level: str) -> int:
    """Return the place of one level; raises StatisticsError with those there are."""
    places = level_places(levels)
    place = places.get(level, places.get(as_number(level)))
    if place is None:
        raise StatisticsError(f"There is no level {level!r}; there are: {', '.join(levels)}.")
    return place


def as_number(text: str) -> float | None:
    """The finite number that a text is, or None."""
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(number) and "_" not in text else None


def _natural(level: str) -> tuple[list[tuple[int, float, str]], str]:
    pieces = _DIGITS.split(level.casefold())
    key = [(0, float(one), "") if one.isdigit() else (1, 0.0, one) for one in pieces if one]
    return key, level
