"""Define groups of body parts, for finding joints, editing them together, and locking them.

A group names some body parts; every body part is also a group of its own. The axes of a group are
the driven axes of its parts, so the hips and the shoulders, which have none, only matter for
colliders. An arm excludes its fingers, as in the thesis: with an arm in a cast, the fingers still
move.

Source: Karas (2020), section 6.4.2 and figure 6.2.
"""

from collections.abc import Mapping
from types import MappingProxyType

from app.science.avatar.body import AXES_OF, AXIS_NAMES, FINGER_PARTS, PART_NAMES
from app.science.avatar.configuration.axis_settings import AvatarProblem, AvatarSettingsError

_TRUNK = ("Hips", "Spine", "Chest", "UpperChest")
_HEAD = ("Neck", "Head")


def _of_side(side: str) -> dict[str, tuple[str, ...]]:
    key = side.lower()
    foot = (f"{side}Foot", f"{side}Toes")
    arm = tuple(f"{side}{part}" for part in ("Shoulder", "UpperArm", "LowerArm", "Hand"))
    return {
        f"{key}_leg": (f"{side}UpperLeg", f"{side}LowerLeg", *foot),
        f"{key}_foot": foot,
        f"{key}_arm": arm,
        f"{key}_fingers": tuple(part for part in FINGER_PARTS if part.startswith(side)),
    }


GROUPS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "all": PART_NAMES,
        "trunk": _TRUNK,
        "trunk_head": (*_TRUNK, *_HEAD),
        "head": _HEAD,
        **_of_side("Left"),
        **_of_side("Right"),
    }
)
"""Parts of each group, from the hips outwards."""
GROUP_NAMES: tuple[str, ...] = (*GROUPS, *PART_NAMES)
"""Every name that `parts_of` accepts, the larger groups first."""


def parts_of(group: str) -> tuple[str, ...]:
    """Return the body parts of a group, or the part itself; raises AvatarSettingsError."""
    if group in AXES_OF:
        return (group,)
    if group in GROUPS:
        return GROUPS[group]
    raise AvatarSettingsError(
        (
            AvatarProblem(
                "",
                f"There is no body group {group!r}.",
                value=group,
                valid=list(GROUP_NAMES),
                remedy="Name a group, or a body part as in Unity's HumanBodyBones.",
            ),
        )
    )


def axes_of(group: str) -> tuple[str, ...]:
    """Return the names of a group's driven axes in the body's order; raises AvatarSettingsError."""
    parts = set(parts_of(group))
    return tuple(axis.name for part in PART_NAMES if part in parts for axis in AXES_OF[part])


PART_OF: Mapping[str, str] = MappingProxyType(
    {axis.name: part for part in PART_NAMES for axis in AXES_OF[part]}
)
"""Body part of each axis, in the order of `AXIS_NAMES`."""
AXIS_ORDER: Mapping[str, int] = MappingProxyType(
    {name: index for index, name in enumerate(AXIS_NAMES)}
)
