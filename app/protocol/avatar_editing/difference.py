"""Say how two avatar configurations differ: value by value, as their files name the values."""

from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from app.protocol.avatar import content_of
from app.science.avatar.configuration import GROUPS, PART_OF, Configuration

SEPARATE_GROUPS: tuple[str, ...] = (
    "trunk", "head", "left_arm", "left_fingers", "right_arm", "right_fingers", "left_leg",
    "right_leg",
)  # fmt: skip
"""Body groups that together contain every part once."""
UNITS: Mapping[str, str] = {
    "kp_nm_per_rad": "N m/rad",
    "kd_nm_s_per_rad": "N m s/rad",
    "max_torque_nm": "N m",
    "low_deg": "deg",
    "high_deg": "deg",
    "held_deg": "deg",
    "total_mass_kg": "kg",
    "delays_ms": "ms",
    "relative_masses_percent": "%",
    "stiffness_percent": "%",
}


@dataclass(frozen=True)
class ValueChange:
    """One value that differs.

    Attributes:
        path: its place in the file, such as `axes.LeftUpperLegX.kp_nm_per_rad`.
        field: its key in the file, such as `kp_nm_per_rad`, `held_deg` or `gravity`.
        part: the body part that it belongs to; None for a value of the whole body.
        axis: the axis that it belongs to, or None.
        unit: its unit, or empty.
        old, new: the values; None where a configuration does not have the value.
    """

    path: str
    field: str
    part: str | None
    axis: str | None
    unit: str
    old: Any
    new: Any

    @property
    def is_compliance(self) -> bool:
        """Return whether it says how a group gives way when it is pushed."""
        return self.path.startswith("compliance.")

    @property
    def groups(self) -> tuple[str, ...]:
        """Return the body groups that it concerns, but `all`: those of its part, or its own."""
        if self.is_compliance:
            return (self.path.split(".")[1],)
        return tuple(name for name, parts in GROUPS.items() if name != "all" and self.part in parts)


def differences(old: Configuration, new: Configuration) -> tuple[ValueChange, ...]:
    """Return every value in which two configurations differ, in the order of the file."""
    return tuple(_compared((), content_of(old), content_of(new)))


def sums_by_group(changes: Collection[ValueChange]) -> dict[str, tuple[tuple[str, ...], int]]:
    """Return the groups that differ: their changed parts, and how many values differ.

    The groups do not overlap and contain every part; the values of the whole body are in none. A
    group whose compliance alone differs has no changed part.
    """
    counts: Counter[str] = Counter(one.part for one in changes if one.part is not None)
    own: Counter[str] = Counter(one.groups[0] for one in changes if one.is_compliance)
    found: dict[str, tuple[tuple[str, ...], int]] = {}
    for group in SEPARATE_GROUPS:
        parts = tuple(part for part in GROUPS[group] if part in counts)
        if parts or group in own:
            found[group] = parts, sum(counts[part] for part in parts) + own[group]
    return found


def _compared(path: tuple[str, ...], old: Any, new: Any) -> Iterator[ValueChange]:
    if isinstance(old, dict) or isinstance(new, dict):
        before, after = old or {}, new or {}
        for key in dict.fromkeys((*before, *after)):
            yield from _compared((*path, key), before.get(key), after.get(key))
    elif old != new:
        yield _change(path, old, new)


def _change(path: tuple[str, ...], old: Any, new: Any) -> ValueChange:
    axis = next((name for name in path if name in PART_OF), None)
    part = (
        PART_OF[axis] if axis else next((name for name in path[1:] if name in GROUPS["all"]), None)
    )
    field = path[-1] if path[0] in ("axes", "compliance") else path[0]
    return ValueChange(".".join(path), field, part, axis, UNITS.get(field, ""), old, new)
