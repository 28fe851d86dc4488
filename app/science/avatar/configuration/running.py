"""Describe the settings of a running avatar that can change without building its model again.

A configuration says how an avatar is built. Gravity, collisions, casts and the motors' gains can
also be changed while it runs: by a study for one of its phases, or by an operator. A running
model is always given all settings in force (`RunningSettings`), never a single change: so it does
not matter in which order changes were made, or whether one was missed.

A cast holds the axes of a body group. It holds them at given angles, or where they are when it is
put on (an angle of None). Axes that the configuration locks have no hinge and are not affected.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from app.science.avatar.body import PART_NAMES
from app.science.avatar.configuration.axis_settings import AxisSettings
from app.science.avatar.configuration.configuration import Configuration
from app.science.avatar.configuration.groups import PART_OF
from app.science.avatar.configuration.model_options import ColliderKind


@dataclass(frozen=True)
class RunningSettings:
    """The settings in force of an avatar that runs.

    Attributes:
        gravity: whether gravity acts on the body.
        self_collision: whether body parts collide with each other, as `layers` says.
        colliders: body part -> the collider that it uses.
        layers: the pairs of collision layers that collide.
        held_rad: held axis -> its angle, or None for its angle when the cast is put on.
        axes: driven axis -> its gains and greatest torque.
    """

    gravity: bool
    self_collision: bool
    colliders: Mapping[str, ColliderKind]
    layers: frozenset[frozenset[str]]
    held_rad: Mapping[str, float | None]
    axes: Mapping[str, AxisSettings]

    @property
    def held_parts(self) -> tuple[str, ...]:
        """Return the body parts in a cast, that is, with an axis that is held."""
        parts = {PART_OF[axis] for axis in self.held_rad}
        return tuple(part for part in PART_NAMES if part in parts)

    @property
    def passing_parts(self) -> tuple[str, ...]:
        """Return the body parts without a collider, which pass through everything."""
        return tuple(part for part in PART_NAMES if self.colliders.get(part) == "none")

    def __hash__(self) -> int:
        return hash((self.gravity, self.self_collision, tuple(self.held_rad)))


def as_configured(configuration: Configuration) -> RunningSettings:
    """Return the settings of an avatar to which nothing has been changed."""
    locked = configuration.locked_axes
    return RunningSettings(
        gravity=configuration.gravity,
        self_collision=configuration.self_collision,
        colliders={part: configuration.collider_of(part) for part in PART_NAMES},
        layers=configuration.colliding,
        held_rad={},
        axes={
            name: settings for name, settings in configuration.motors.items() if name not in locked
        },
    )
