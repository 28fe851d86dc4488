"""Define a configuration: everything about an avatar's behaviour, except its size and its latency.

A configuration holds the settings of every driven axis and those of the body as a whole. The body's
lengths come from the participant's stature or from a model, the added latency from the study; so
one configuration serves many people and conditions, and its hash identifies a behaviour.

A group of body parts can be locked, as by a plaster cast: its axes then stay at fixed angles, while
their limits are stored for when it is unlocked. `in_force` gives the settings with locks applied;
`axes` does not.
"""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final, Literal, cast, get_args

from app.science.avatar.body import (
    AXES_OF,
    AXIS_NAMES,
    COLLIDING,
    PART_NAMES,
    REQUIRED_PARTS,
    Population,
)
from app.science.avatar.configuration.axis_settings import (
    AvatarProblem,
    AvatarSettingsError,
    AxisSettings,
    degrees_of,
    rounded_angle,
)
from app.science.avatar.configuration.compliance import (
    Compliance,
    compliance_problems,
    normal,
    softened,
)
from app.science.avatar.configuration.groups import AXIS_ORDER, GROUP_NAMES, PART_OF, axes_of
from app.science.avatar.configuration.model_options import ColliderKind
from app.science.avatar.configuration.optional import (
    MS_PER_S,
    PERCENT,
    delay_problems,
    layer_problems,
    mass_problems,
    ordered,
)

Hips = Literal["carried", "welded"]
TargetSpace = Literal["local", "world"]

DEFAULT_MASS_KG: Final = 72.0
"""Mass of the thesis's avatar (figure 6.1)."""
MIN_MASS_KG: Final = 1.0
MAX_MASS_KG: Final = 500.0
_HASH = re.compile(r"[0-9a-f]{64}")
_CHOICES: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("population", get_args(Population)),
    ("hips", get_args(Hips)),
    ("target_space", get_args(TargetSpace)),
    ("colliders", get_args(ColliderKind)),
)


@dataclass(frozen=True)
class Configuration:
    """The settings that determine how an avatar behaves.

    Attributes:
        axes: axis -> settings, always in the order of `AXIS_NAMES`. A part that a model lacks is
            absent; a part that is present has all of its axes.
        total_mass_kg: the mass of the body, distributed among its parts.
        population: supplies the relative masses of the parts.
        gravity: whether gravity acts on the body.
        self_collision: whether parts collide with each other as the layers define.
        hips: `carried` sets the pose of the hips to the participant's at each step, so the limbs
            have no effect on them; `welded` pulls them there by a stiff constraint.
        target_space: `local` drives each joint to the participant's joint angles; `world` to the
            angles that give the part the participant's orientation in the room, so that a limb that
            is pushed aside gives way and still points in the right direction.
        colliders: the colliders of all parts but those in `part_colliders`.
        part_colliders: body part -> colliders.
        humanoid: SHA-256 of the file of the model that gives the body its joints, lengths and skin;
            None for a body of the participant's stature. `mesh` colliders need one.
        locked_groups: groups that are locked, in the order of `GROUP_NAMES`, each once.
        held_rad: axis -> angle at which an axis of a locked group is held; axes that are absent are
            held at the T-pose's.
        colliding: the pairs of collision layers whose parts collide, if `self_collision` is on.
        delays_s: body part -> time by which the targets of its axes lag behind those of the other
            parts, in addition to the latency of the condition.
        relative_masses: body part -> its share of the mass, above zero. The other parts share the
            rest as the population has it.
        compliance: group -> how it gives way, by the names of `COMPLIANT_GROUPS`; groups that are
            absent are stiff.

    Raises:
        AvatarSettingsError: a value is invalid; the error lists all that are.
    """

    axes: Mapping[str, AxisSettings]
    total_mass_kg: float = DEFAULT_MASS_KG
    population: Population = "average"
    gravity: bool = True
    self_collision: bool = True
    hips: Hips = "carried"
    target_space: TargetSpace = "local"
    colliders: ColliderKind = "simple"
    part_colliders: Mapping[str, ColliderKind] = field(default_factory=dict)
    locked_groups: tuple[str, ...] = ()
    held_rad: Mapping[str, float] = field(default_factory=dict)
    humanoid: str | None = None
    colliding: frozenset[frozenset[str]] = COLLIDING
    delays_s: Mapping[str, float] = field(default_factory=dict)
    relative_masses: Mapping[str, float] = field(default_factory=dict)
    compliance: Mapping[str, Compliance] = field(default_factory=dict)

    def __post_init__(self) -> None:
        problems = tuple(_problems_of(self))
        if problems:
            raise AvatarSettingsError(problems)
        axes = {name: self.axes[name] for name in AXIS_NAMES if name in self.axes}
        colliders = {
            part: self.part_colliders[part] for part in PART_NAMES if part in self.part_colliders
        }
        held = {name: rounded_angle(self.held_rad[name]) for name in axes if name in self.held_rad}
        delays = {
            part: delay_s for part, delay_s in ordered(self.delays_s, MS_PER_S).items() if delay_s
        }
        locked = tuple(name for name in GROUP_NAMES if name in self.locked_groups)
        for name, value in (
            ("axes", MappingProxyType(axes)),
            ("total_mass_kg", float(self.total_mass_kg)),
            ("part_colliders", MappingProxyType(colliders)),
            ("locked_groups", locked),
            ("held_rad", MappingProxyType(held)),
            ("delays_s", MappingProxyType(delays)),
            ("relative_masses", MappingProxyType(ordered(self.relative_masses, PERCENT))),
            ("compliance", MappingProxyType(normal(self.compliance))),
        ):
            object.__setattr__(self, name, value)

    @property
    def parts(self) -> tuple[str, ...]:
        """Return the driven parts that the model has."""
        return tuple(dict.fromkeys(PART_OF[name] for name in self.axes))

    @property
    def locked_axes(self) -> frozenset[str]:
        """Return the axes that are in a locked group, or whose limits leave no range."""
        held = {name for group in self.locked_groups for name in axes_of(group)}
        return frozenset(
            name for name, settings in self.axes.items() if settings.locked or name in held
        )

    @property
    def in_force(self) -> Mapping[str, AxisSettings]:
        """Return the settings of each axis with the locked groups applied, as a body is built."""
        held = {name for group in self.locked_groups for name in axes_of(group)}
        return MappingProxyType(
            {
                name: settings.locked_at(self.held_rad.get(name, 0.0)) if name in held else settings
                for name, settings in self.axes.items()
            }
        )

    @property
    def motors(self) -> Mapping[str, AxisSettings]:
        """Return `in_force` with the stiffness of compliant groups, as motors are built."""
        return MappingProxyType(softened(self.in_force, self.compliance))

    def collider_of(self, part: str) -> ColliderKind:
        """Return the kind of collider of a body part."""
        return self.part_colliders.get(part, self.colliders)

    @property
    def uses_pieces(self) -> bool:
        """Return whether any part is configured to collide as a convex piece of a model's skin."""
        return "mesh" in {self.colliders, *self.part_colliders.values()}

    def __hash__(self) -> int:
        return hash((tuple(self.axes.items()), self.total_mass_kg, self.locked_groups))


def _problems_of(configuration: Configuration) -> Iterator[AvatarProblem]:
    """Yield everything that is invalid in a configuration."""
    yield from _axes_problems(configuration)
    yield from _body_problems(configuration)
    yield from _lock_problems(configuration)
    yield from layer_problems(configuration.colliding)
    yield from delay_problems(configuration.delays_s)
    yield from mass_problems(configuration.relative_masses)
    yield from compliance_problems(configuration.compliance, configuration.delays_s)


def piece_problems(configuration: Configuration) -> Iterator[AvatarProblem]:
    """Yield a problem if colliders are pieces of a model's skin and no model is named.

    This is checked when a configuration is saved or built, not whenever one is read.
    """
    if configuration.humanoid is not None or not configuration.uses_pieces:
        return
    named = [part for part, kind in configuration.part_colliders.items() if kind == "mesh"]
    yield AvatarProblem(
        "colliders" if configuration.colliders == "mesh" else f"part_colliders.{named[0]}",
        "Colliders of the kind 'mesh' are pieces of a model's skin, and no model is named.",
        value="mesh",
        valid=["simple", "none"],
        remedy="Upload a humanoid model and name its hash as 'humanoid', or choose 'simple'.",
    )


def idle_delay_problems(configuration: Configuration) -> Iterator[AvatarProblem]:
    """Yield a problem for every delay of a part without axes, such as the hips.

    This is checked when a configuration is saved, not whenever one is read.
    """
    for part in configuration.delays_s:
        if not AXES_OF.get(part):
            yield AvatarProblem(
                f"delays_ms.{part}",
                f"{part} has no axis that could lag behind: it moves with the participant's.",
                value=part,
                valid=[one for one in PART_NAMES if AXES_OF.get(one)],
                remedy="Take this delay out, or give it to a part with axes.",
            )


def missing_part_problems(configuration: Configuration) -> Iterator[AvatarProblem]:
    """Yield a problem if parts without which no body can be built have no axes.

    This is checked when a configuration is saved, not whenever one is read.
    """
    required = [part for part in REQUIRED_PARTS if AXES_OF.get(part)]
    missing = [part for part in required if part not in configuration.parts]
    if missing:
        yield AvatarProblem(
            "axes",
            f"No body can be built without {', '.join(missing)}.",
            value=missing,
            valid=required,
            remedy="Give all axes of these parts.",
        )


def _axes_problems(configuration: Configuration) -> Iterator[AvatarProblem]:
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
        required = [axis.name for axis in AXES_OF[part]]
        missing = [name for name in required if name not in axes]
        if missing:
            yield AvatarProblem(
                f"axes.{missing[0]}",
                f"{part} lacks its axis {missing[0]}.",
                valid=required,
                remedy=f"Give all axes of {part}, or none where the model lacks the part.",
            )


def _body_problems(configuration: Configuration) -> Iterator[AvatarProblem]:
    mass = configuration.total_mass_kg
    if not (math.isfinite(mass) and MIN_MASS_KG <= mass <= MAX_MASS_KG):
        yield AvatarProblem(
            "total_mass_kg",
            f"{mass} kg is not a valid body mass.",
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
            "This is not the hash of a model.",
            value=configuration.humanoid,
            valid="64 hexadecimal digits",
            remedy="Give the hash of an uploaded humanoid model, or leave it out.",
        )
    for part, kind in configuration.part_colliders.items():
        if part not in AXES_OF:
            yield _choice_problem(f"part_colliders.{part}", part, PART_NAMES)
        if kind not in get_args(ColliderKind):
            yield _choice_problem(f"part_colliders.{part}", kind, get_args(ColliderKind))


def _lock_problems(configuration: Configuration) -> Iterator[AvatarProblem]:
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
        elif not settings.low_rad <= rounded_angle(angle_rad) <= settings.high_rad:
            low, high = degrees_of(settings.low_rad), degrees_of(settings.high_rad)
            yield AvatarProblem(
                path,
                f"{name} cannot be held at {math.degrees(angle_rad):g} deg.",
                value=degrees_of(angle_rad),
                valid=f"from {low:g} to {high:g}",
                remedy="Give an angle within its limits, or widen them.",
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
