"""Edits of a configuration: each gives a new one, so undoing is keeping the old."""

from collections.abc import Mapping
from dataclasses import replace

from app.science.avatar.body import mirrored_name
from app.science.avatar.configuration.axis_settings import AxisSettings
from app.science.avatar.configuration.configuration import Configuration
from app.science.avatar.configuration.groups import axes_of, parts_of


def lock(
    configuration: Configuration, group: str, held_rad: Mapping[str, float] | None = None
) -> Configuration:
    """Hold a group of body parts still, as a cast would; its limits are kept for later.

    Args:
        configuration: what is edited.
        group: a body group or a part.
        held_rad: axis of the group -> angle at which it is held; the T-pose's where it is left out,
            as far as the limits allow. Locking a locked group anew replaces its angles.

    Raises:
        AvatarSettingsError: no such group, an axis of another group, an angle beyond the limits.
    """
    return replace(
        configuration,
        locked_groups=(*(one for one in configuration.locked_groups if one != group), group),
        held_rad={**_held_outside(configuration, group), **(held_rad or {})},
    )


def unlock(configuration: Configuration, group: str) -> Configuration:
    """Let a locked group move again; groups that overlap it stay locked.

    Raises AvatarSettingsError where there is no such group.
    """
    parts_of(group)
    left = tuple(one for one in configuration.locked_groups if one != group)
    still = {name for one in left for name in axes_of(one)}
    held = {name: angle for name, angle in configuration.held_rad.items() if name in still}
    return replace(configuration, locked_groups=left, held_rad=held)


def mirror_left_to_right(configuration: Configuration) -> Configuration:
    """Give every right axis the settings of the left one.

    A positive angle is the same movement on both sides, so nothing changes its sign. Locked groups
    and colliders stay, and so do parts that only one side of the model has.
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
    """Give every axis of a group the same gains or torque; what is None stays.

    Raises AvatarSettingsError: no such group, or a value that cannot be.
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
    """The configuration with one axis set anew; raises AvatarSettingsError for an unknown one."""
    return replace(configuration, axes={**configuration.axes, name: settings})


def without_parts(configuration: Configuration, missing: frozenset[str]) -> Configuration:
    """The configuration for a model that lacks some body parts, such as a finger."""
    gone = {name for part in missing for name in axes_of(part)}
    return replace(
        configuration,
        axes={name: one for name, one in configuration.axes.items() if name not in gone},
        held_rad={name: one for name, one in configuration.held_rad.items() if name not in gone},
    )


def _held_outside(configuration: Configuration, group: str) -> dict[str, float]:
    own = set(axes_of(group))
    return {name: angle for name, angle in configuration.held_rad.items() if name not in own}
