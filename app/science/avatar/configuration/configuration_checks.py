"""Whether the values of a configuration can be, one by one and together; see `configuration`."""

import math
import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final, Literal, cast, get_args

from app.science.avatar.body.deleva import Population
from app.science.avatar.body.parts import AXES_OF, AXIS_NAMES, PART_NAMES
from app.science.avatar.configuration.axis_settings import AvatarProblem, degrees_of, settled_angle
from app.science.avatar.configuration.colliders import ColliderKind
from app.science.avatar.configuration.groups import AXIS_ORDER, GROUP_NAMES, PART_OF, axes_of

if TYPE_CHECKING:
    from app.science.avatar.configuration.configuration import Configuration

Hips = Literal["carried", "welded"]
TargetSpace = Literal["local", "world"]

MIN_MASS_KG: Final = 1.0
MAX_MASS_KG: Final = 500.0
_HASH = re.compile(r"[0-9a-f]{64}")
_CHOICES: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("population", get_args(Population)),
    ("hips", get_args(Hips)),
    ("target_space", get_args(TargetSpace)),
    ("colliders", get_args(ColliderKind)),
)


def problems_of(configuration: "Configuration") -> Iterator[AvatarProblem]:
    """Everything that makes a configuration impossible."""
    yield from _axes_problems(configuration)
    yield from _body_problems(configuration)
    yield from _lock_problems(configuration)


def piece_problems(configuration: "Configuration") -> Iterator[AvatarProblem]:
    """Pieces without a model whose they are: a configuration like that is no avatar.

    Asked when one is saved or built, not of every one that is read.
    """
    if configuration.humanoid is not None or not configuration.wants_pieces:
        return
    named = [part for part, kind in configuration.part_colliders.items() if kind == "mesh"]
    yield AvatarProblem(
        "colliders" if configuration.colliders == "mesh" else f"part_colliders.{named[0]}",
        "Colliders of the kind 'mesh' are pieces of a model's skin, and no model is named.",
        value="mesh",
        valid=["simple", "none"],
        remedy="Upload a humanoid model and name its hash as 'humanoid', or choose 'simple'.",
    )


def _axes_problems(configuration: "Configuration") -> Iterator[AvatarProblem]:
    axes = configuration.axes
    if not axes:
        yield AvatarProblem("axes", "No axis is given.", valid=list(AXIS_NAMES))
    for name in axes:
        if name not in AXIS_ORDER:
            yield AvatarProblem(
                f"axes.{name}",
                f"There is no axis {name!r}.",
                value=name,
                valid=list(AXIS_NAMES),
                remedy="Name it after its body part and X, Y or Z, as in LeftUpperLegX.",
            )
    for part in dict.fromkeys(PART_OF[name] for name in axes if name in PART_OF):
        wanted = [axis.name for axis in AXES_OF[part]]
        missing = [name for name in wanted if name not in axes]
        if missing:
            yield AvatarProblem(
                f"axes.{missing[0]}",
                f"{part} lacks its axis {missing[0]}.",
                valid=wanted,
                remedy=f"Give all axes of {part}, or none where the model lacks the part.",
            )


def _body_problems(configuration: "Configuration") -> Iterator[AvatarProblem]:
    mass = configuration.total_mass_kg
    if not (math.isfinite(mass) and MIN_MASS_KG <= mass <= MAX_MASS_KG):
        yield AvatarProblem(
            "total_mass_kg",
            f"{mass} kg is no mass of a body.",
            value=mass,
            valid=f"from {MIN_MASS_KG:g} to {MAX_MASS_KG:g}",
            remedy="Give the mass of the whole body in kilograms.",
        )
    for name, choices in _CHOICES:
        value = cast("str", getattr(configuration, name))
        if value not in choices:
            yield _choice_problem(name, value, choices)
    if configuration.humanoid is not None and not _HASH.fullmatch(configuration.humanoid):
        yield AvatarProblem(
            "humanoid",
            "This names no model.",
            value=configuration.humanoid,
            valid="64 hexadecimal digits",
            remedy="Give the hash of an uploaded humanoid model, or leave it out.",
        )
    for part, kind in configuration.part_colliders.items():
        if part not in AXES_OF:
            yield _choice_problem(f"part_colliders.{part}", part, PART_NAMES)
        if kind not in get_args(ColliderKind):
            yield _choice_problem(f"part_colliders.{part}", kind, get_args(ColliderKind))


def _lock_problems(configuration: "Configuration") -> Iterator[AvatarProblem]:
    held: set[str] = set()
    for index, group in enumerate(configuration.locked_groups):
        if group not in GROUP_NAMES:
            yield _choice_problem(f"locked_groups[{index}]", group, GROUP_NAMES)
            continue
        held.update(axes_of(group))
    for name, angle_rad in configuration.held_rad.items():
        settings = configuration.axes.get(name)
        path = f"held_deg.{name}"
        if settings is None or name not in held:
            free = [one for one in AXIS_NAMES if one in held and one in configuration.axes]
            yield AvatarProblem(
                path,
                f"{name} is not an axis of a locked group, so it cannot be held.",
                value=name,
                valid=free,
                remedy="Lock its group, or take the angle out.",
            )
        elif not settings.low_rad <= settled_angle(angle_rad) <= settings.high_rad:
            low, high = degrees_of(settings.low_rad), degrees_of(settings.high_rad)
            yield AvatarProblem(
                path,
                f"{name} cannot be held at {math.degrees(angle_rad):g} deg.",
                value=math.degrees(angle_rad),
                valid=f"from {low:g} to {high:g}",
                remedy="Hold it within its limits, or widen them.",
            )


def _choice_problem(path: str, value: object, choices: tuple[str, ...]) -> AvatarProblem:
    return AvatarProblem(
        path,
        f"{value!r} is not one of the choices.",
        value=value,
        valid=list(choices),
        remedy=f"Choose one of {', '.join(choices)}."
        if len(choices) < 10
        else "Choose one of the valid names.",
    )
