"""Further dependencies: numbers that a user names, such as a load in kilograms.

The paper's model depends on length, turning and stature, "but not limited to" these (Agethen,
Gaisbauer and Rukzio 2018, section 4). Any number that is known before a walk begins, and is the
same during all of it, can be one more: a load, the height of a shelf, 1 or 0 for whether a display
is looked at.

A model needs the number of every walk that it learns from. A walk without it is left out, with its
reason; if that would leave out more than half of the walks, the dependency is refused, because the
model would then be one of other walks than those that were given.
"""

import re
from collections.abc import Sequence
from typing import Final

from app.science.walking.records.model import LENGTH, STATURE, TURNING, PlannedWalk, WalkingError

NAME_PATTERN: Final = r"^[A-Za-z][A-Za-z0-9_]{0,39}$"
"""What a further dependency may be called; its unit at the end, as in `load_kg`, is shown."""
MOST_FURTHER: Final = 3
"""Most further dependencies of one model: each needs walks over its whole range."""
LEAST_KNOWN: Final = 0.5
"""Smallest share of the walks for which a dependency has to be known."""
_TAKEN: Final = {LENGTH, TURNING, STATURE, "length", "turning", "stature"}


def check_name(name: str) -> None:
    """Raise WalkingError unless a further dependency may have this name; says which may."""
    if name.lower() in _TAKEN:
        raise WalkingError(
            f"The name {name!r} is taken: every model depends on length and turning, which are"
            " computed from the path, and on stature, which is given as stature_m. Choose another,"
            " such as load_kg."
        )
    if not re.fullmatch(NAME_PATTERN, name):
        raise WalkingError(
            f"The name {name!r} is not valid: it begins with a letter and has up to 40 letters,"
            " digits and underscores, with the unit at its end, such as load_kg."
        )


def check_names(names: Sequence[str]) -> None:
    """Raise WalkingError for too many further dependencies, a repeated one, or a name not valid."""
    for name in names:
        check_name(name)
    if len(names) > MOST_FURTHER or len(set(names)) < len(names):
        raise WalkingError(
            f"{len(names)} further dependencies, {', '.join(names)}: up to {MOST_FURTHER} are"
            " valid, each once. Choose those that matter most."
        )


def is_name(name: str) -> bool:
    """Return whether a further dependency may have this name."""
    return name.lower() not in _TAKEN and re.fullmatch(NAME_PATTERN, name) is not None


def further_of(names: Sequence[str]) -> tuple[str, ...]:
    """Return those names of a model's dependencies that a user gave: all but the paper's three."""
    return tuple(name for name in names if name not in (LENGTH, TURNING, STATURE))


def known_for(entries: Sequence[PlannedWalk], names: Sequence[str]) -> dict[int, str]:
    """Return the walks that lack one of these dependencies: the index of each, and why.

    Args:
        entries: all walks.
        names: the further dependencies of the model that the walks are for.

    Raises:
        WalkingError: there are too many names, or the same twice; one is not valid; it is known for
            too few of the walks.
    """
    check_names(names)
    reasons: dict[int, str] = {}
    for name in names:
        missing = {
            at: _missing(entry, name)
            for at, entry in enumerate(entries)
            if name not in entry.dependencies
        }
        if len(entries) - len(missing) < max(1.0, LEAST_KNOWN * len(entries)):
            raise WalkingError(
                f"{name} is known for {len(entries) - len(missing)} of {len(entries)} walks, and at"
                f" least half are needed. Of the first without it: {next(iter(missing.values()))}."
                f" Give {name} for the others, or choose other dependencies."
            )
        reasons = missing | reasons
    return dict(sorted(reasons.items()))


def check_varies(entries: Sequence[PlannedWalk], names: Sequence[str]) -> None:
    """Raise WalkingError if one of the dependencies is the same for all walks of a fit."""
    for name in names:
        values = {entry.dependencies[name] for entry in entries}
        if len(values) == 1:
            raise WalkingError(
                f"{name} is {values.pop():g} for all {len(entries)} walks: what differs with it"
                " cannot be learnt. Add walks with another value, or choose other dependencies."
            )


def _missing(entry: PlannedWalk, name: str) -> str:
    if name in entry.walk.changing:
        low, high = entry.walk.changing[name]
        return (
            f"{name} changes from {low:g} to {high:g} during it, and a model needs a number that is"
            " known before the walk: give one for the whole walk"
        )
    return f"{name} is not known"
