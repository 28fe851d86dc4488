"""Edit a configuration: each function returns a new one and leaves the original unchanged."""

from collections.abc import Mapping
from dataclasses import replace

from app.science.avatar.body import mirrored_name
from app.science.avatar.configuration.axis_settings import AxisSettings
from app.science.avatar.configuration.configuration import Configuration
from app.science.avatar.configuration.groups import axes_of, parts_of


def lock(
    configuration: Configuration, group: str, held_rad: Mapping[str, float] | None = None
) -> Configuration:
    """Lock a group of body parts, as by a plaster cast, and keep its limits for unlocking.

    Args:
        configuration: the configuration to edit.
        group: a body group or a part.
        held_rad: axis of the group -> angle at which it is held; axes that are absent are held at
            the T-pose's, as far as the limits allow. Locking a locked group replaces its angles.

    Raises:
        AvatarSettingsError: an unknown group, an axis of another group, or an angle beyond the
            limits.
    """
    return replace(
        configuration,
        locked_groups=(*(one for one in configuration.locked_groups if one != group), group),
        held_rad={**_held_outside(configuration, group), **(held_rad or {})},
    )


def unlock(configuration: Configuration, group: str) -> Configuration:
    """Unlock a group; locked groups that overlap it stay locked.

    Raises AvatarSettingsError if there is no such group.
    """
    parts_of(group)
    remaining = tuple(one for one in configuration.locked_groups if one != group)
    still_locked = {name for one in remaining for name in axes_of(one)}
    held = {name: angle for name, angle in configuration.held_rad.items() if name in still_locked}
    return replace(configuration, locked_groups=remaining, held_rad=held)


def mirror_left_to_right(configuration: Configuration) -> Configuration:
    """Give every axis of the right side the settings of its left counterpart.

    A positive angle is the same movement on both sides, so no sign changes. Locked groups and
    colliders stay unchanged, and so do parts that only one side of the model has.
    """
    axes = {
        name: configuration.axes.get(mirrored_name(name), settings)
        if name.startswith("Right")
        else settings
        for name, settings in configuration.axes.items()
    }
    return replace(configuration, axes=axes)


def with_global(
    configuration: Configuration,
    *,
    group: str = "all",
    kp: float | None = None,
    kd: float | None = None,
    max_torque_nm: float | None = None,
) -> Configuration:
    """Give every axis of a group the same gains or torque limit; what is None stays unchanged.

    Raises AvatarSettingsError: no such group, or an invalid value.
    """
    given = {"kp": kp, "kd": kd, "max_torque_nm": max_torque_nm}
    values = {name: value for name, value in given.items() if value is not None}
    chosen = set(axes_of(group))
    axes = {
        name: settings.with_values(**values) if name in chosen else settings
        for name, settings in configuration.axes.items()
    }
    return replace(configuration, axes=axes)


def with_axis(configuration: Configuration, name: str, settings: AxisSettings) -> Configuration:
    """Return the configuration with new settings for one axis.

    Raises AvatarSettingsError for an unknown axis.
    """
    return replace(configuration, axes={**configuration.axes, name: settings})


def without_parts(configuration: Configuration, missing: frozenset[str]) -> Configuration:
    """Return the configuration for a model that lacks some body parts, such as a finger."""
    removed = {name for part in missing for name in axes_of(part)}
    return replace(
        configuration,
        axes={name: one for name, one in configuration.axes.items() if name not in removed},
        held_rad={name: one for name, one in configuration.held_rad.items() if name not in removed},
    )


def _held_outside(configuration: Configuration, group: str) -> dict[str, float]:
    own = set(axes_of(group))
    return {name: angle for name, angle in configuration.held_rad.items() if name not in own}
