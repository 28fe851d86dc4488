"""Everything that decides how an avatar behaves, but not who it is nor how late it is.

A configuration holds the settings of every driven axis and what acts on the body as a whole. The
body's lengths come from the participant's stature or from a model, the added latency from the
study; so one configuration serves many people and conditions, and its hash names a behaviour.

A group of body parts can be locked, as a cast would: its axes then stay where they are held, and
their limits are kept for when it comes off. What is in force is `in_force`, never `axes`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final

from app.science.avatar.body.deleva import Population
from app.science.avatar.body.parts import AXIS_NAMES, PART_NAMES
from app.science.avatar.configuration.axis_settings import (
    AvatarSettingsError,
    AxisSettings,
    settled_angle,
)
from app.science.avatar.configuration.colliders import ColliderKind
from app.science.avatar.configuration.configuration_checks import Hips, TargetSpace, problems_of
from app.science.avatar.configuration.groups import GROUP_NAMES, PART_OF, axes_of

__all__ = ["USUAL_MASS_KG", "ColliderKind", "Configuration", "Hips", "TargetSpace"]
USUAL_MASS_KG: Final = 72.0
"""Of the thesis's avatar (figure 6.1)."""


@dataclass(frozen=True)
class Configuration:
    """How an avatar behaves.

    Attributes:
        axes: axis -> settings, in the order of `AXIS_NAMES` whatever order it came in. A part that
            a model lacks is absent; a part that is there has all of its axes.
        total_mass_kg: of the body, shared out among its parts.
        population: whose relative masses are taken.
        gravity: whether the body is heavy.
        self_collision: whether parts collide with each other as the layers allow.
        hips: `carried` sets the hips where the participant's are at each step, so they feel nothing
            of the limbs; `welded` pulls them there by a stiff bond.
        target_space: `local` drives each joint to the participant's joint angles; `world` to the
            angles that give the part the participant's orientation in the room, so that a limb
            that is pushed aside gives way and still points where it should.
        colliders: of all parts but those in `part_colliders`.
        part_colliders: body part -> colliders.
        humanoid: SHA-256 of the file of the model that gives the body its joints, lengths and
            skin; None for a body of the participant's stature. `mesh` colliders need one.
        locked_groups: groups that are held, in the order of `GROUP_NAMES`, each once.
        held_rad: axis -> angle at which a locked axis is held; the T-pose's where it is absent.

    Raises:
        AvatarSettingsError: with every value that cannot be.
    """

    axes: Mapping[str, AxisSettings]
    total_mass_kg: float = USUAL_MASS_KG
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

    def __post_init__(self) -> None:
        problems = tuple(problems_of(self))
        if problems:
            raise AvatarSettingsError(problems)
        ordered = {name: self.axes[name] for name in AXIS_NAMES if name in self.axes}
        colliders = {
            part: self.part_colliders[part] for part in PART_NAMES if part in self.part_colliders
        }
        held = {
            name: settled_angle(self.held_rad[name]) for name in ordered if name in self.held_rad
        }
        locked = tuple(name for name in GROUP_NAMES if name in self.locked_groups)
        for name, value in (
            ("axes", MappingProxyType(ordered)),
            ("total_mass_kg", float(self.total_mass_kg)),
            ("part_colliders", MappingProxyType(colliders)),
            ("locked_groups", locked),
            ("held_rad", MappingProxyType(held)),
        ):
            object.__setattr__(self, name, value)

    @property
    def parts(self) -> tuple[str, ...]:
        """The driven parts that the model has."""
        return tuple(dict.fromkeys(PART_OF[name] for name in self.axes))

    @property
    def locked_axes(self) -> frozenset[str]:
        """Axes that a locked group holds, or whose limits leave no range."""
        held = {name for group in self.locked_groups for name in axes_of(group)}
        return frozenset(
            name for name, settings in self.axes.items() if settings.locked or name in held
        )

    @property
    def in_force(self) -> Mapping[str, AxisSettings]:
        """Axis -> settings with the locked groups held: what a body is built from."""
        held = {name for group in self.locked_groups for name in axes_of(group)}
        return MappingProxyType(
            {
                name: settings.held_at(self.held_rad.get(name, 0.0)) if name in held else settings
                for name, settings in self.axes.items()
            }
        )

    def collider_of(self, part: str) -> ColliderKind:
        """What a body part collides with."""
        return self.part_colliders.get(part, self.colliders)

    @property
    def wants_pieces(self) -> bool:
        """Whether any part is to collide with a piece of a model's skin."""
        return "mesh" in {self.colliders, *self.part_colliders.values()}

    def __hash__(self) -> int:
        return hash((tuple(self.axes.items()), self.total_mass_kg, self.locked_groups))
