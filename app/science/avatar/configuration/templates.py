"""Convert between the thesis's two templates: one joint per body part, or one joint per axis.

In the *multiple* template each axis of a part has its own limits, gains and torque limit; that is
what a configuration holds. The *single* template has one joint per part, as game engines do. Its
primary axis has a lower and an upper limit and a drive; its other axes have one symmetric limit
each and share one drive.

Single to multiple loses nothing: a symmetric limit L becomes [-L, L], and the shared drive is given
to each of those axes. Multiple to single must choose:

- a symmetric limit is the greater of |low| and |high|, so every pose stays possible;
- the shared drive is that of the stiffest axis (greatest kp, then kd, then torque; then the first
  in the part's order), taken as a whole, because a kp belongs to the kd it was tuned with.

An edit of the single template changes in the multiple one only what was edited. A new symmetric
limit replaces the limit that it was taken from, and the other one stays unchanged; where both are
equally far from the T-pose, it replaces both. A new shared drive goes to every axis that shares it.

Source: Karas (2020), sections 2.2.3, 4.2.3 and 6.3, which leaves the shared drive and equal sides
open ("a compromise", chapter 8); those rules, and the choice of the primary axis, are ours.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

from app.science.avatar.body import AXES_OF, PART_NAMES
from app.science.avatar.configuration.axis_settings import (
    AvatarProblem,
    AvatarSettingsError,
    AxisSettings,
    degrees_of,
    rounded_angle,
)
from app.science.avatar.configuration.configuration import Configuration

# The axis with the greatest and least symmetric range of a part; X for parts that are absent here.
_PRIMARY_LETTERS = {"UpperArm": "Y", "LowerArm": "Y", "Hand": "Z"}


@dataclass(frozen=True)
class Drive:
    """Stiffness, damping and torque limit of a drive; units and ranges as in `AxisSettings`."""

    kp: float
    kd: float
    max_torque_nm: float


@dataclass(frozen=True)
class SingleJoint:
    """The one joint of a body part in the single template.

    Attributes:
        part: HumanBodyBones name of a driven part.
        low_rad: lower limit about the primary axis.
        high_rad: upper limit about the primary axis.
        drive: the drive of the primary axis.
        limits_rad: other axis -> its symmetric limit, zero or more, in the part's order.
        shared_drive: the drive of the other axes; None if there are none.

    Raises:
        AvatarSettingsError: the part is not driven, the axes are not the part's, or a limit is
            invalid.
    """

    part: str
    low_rad: float
    high_rad: float
    drive: Drive
    limits_rad: Mapping[str, float]
    shared_drive: Drive | None

    def __post_init__(self) -> None:
        others = shared_axes(self.part)
        problem = _joint_problem(self, others)
        if problem is not None:
            raise AvatarSettingsError((problem,))
        for name in ("low_rad", "high_rad"):
            object.__setattr__(self, name, rounded_angle(getattr(self, name)))
        limits = {name: rounded_angle(self.limits_rad[name]) for name in others}
        object.__setattr__(self, "limits_rad", MappingProxyType(limits))


def primary_axis(part: str) -> str:
    """Return the axis with its own limits and drive; raises AvatarSettingsError."""
    axes = AXES_OF.get(part, ())
    if not axes:
        driven = [name for name in PART_NAMES if AXES_OF[name]]
        raise AvatarSettingsError(
            (
                AvatarProblem(
                    "part",
                    f"{part!r} is not a driven body part.",
                    value=part,
                    valid=driven,
                    remedy="Name a driven part, as in LeftUpperLeg.",
                ),
            )
        )
    base = part.removeprefix("Left").removeprefix("Right")
    letter = _PRIMARY_LETTERS.get(base, "X")
    # Fingers have no X; their first axis bends them.
    return next((axis.name for axis in axes if axis.letter == letter), axes[0].name)


def shared_axes(part: str) -> tuple[str, ...]:
    """Return the axes with symmetric limits and a shared drive; raises AvatarSettingsError."""
    primary = primary_axis(part)
    return tuple(axis.name for axis in AXES_OF[part] if axis.name != primary)


def to_multiple(joint: SingleJoint) -> dict[str, AxisSettings]:
    """Return the settings of each axis of a joint; raises AvatarSettingsError."""
    settings = {
        primary_axis(joint.part): _driven(joint.drive, joint.low_rad, joint.high_rad),
    }
    if joint.shared_drive is not None:
        for name, limit in joint.limits_rad.items():
            settings[name] = _driven(joint.shared_drive, -limit, limit)
    return {axis.name: settings[axis.name] for axis in AXES_OF[joint.part]}


def to_single(part: str, axes: Mapping[str, AxisSettings]) -> SingleJoint:
    """Return the part's axes as one joint; `axes` must have all of them and may have others."""
    primary = axes[primary_axis(part)]
    shared = [axes[name] for name in shared_axes(part)]
    return SingleJoint(
        part=part,
        low_rad=primary.low_rad,
        high_rad=primary.high_rad,
        drive=_drive(primary),
        limits_rad={
            name: max(abs(axes[name].low_rad), abs(axes[name].high_rad))
            for name in shared_axes(part)
        },
        shared_drive=_stiffest(shared),
    )


def edited(joint: SingleJoint, axes: Mapping[str, AxisSettings]) -> dict[str, AxisSettings]:
    """Return the part's axes after its single joint is edited to `joint`.

    Args:
        joint: the single joint after the edit.
        axes: the part's axes before the edit.

    Raises:
        AvatarSettingsError: a value is invalid.
    """
    previous = to_single(joint.part, axes)
    primary = primary_axis(joint.part)
    changed: dict[str, AxisSettings] = {
        primary: _driven(joint.drive, joint.low_rad, joint.high_rad)
    }
    for name in shared_axes(joint.part):
        settings = axes[name]
        if joint.limits_rad[name] != previous.limits_rad[name]:
            settings = _with_limit(settings, joint.limits_rad[name])
        if joint.shared_drive is not None and joint.shared_drive != previous.shared_drive:
            settings = _driven(joint.shared_drive, settings.low_rad, settings.high_rad)
        changed[name] = settings
    return {axis.name: changed[axis.name] for axis in AXES_OF[joint.part]}


def single_template(configuration: Configuration) -> dict[str, SingleJoint]:
    """Return every driven part of the configuration as one joint."""
    return {part: to_single(part, configuration.axes) for part in configuration.parts}


def with_single_template(
    configuration: Configuration, joints: Iterable[SingleJoint]
) -> Configuration:
    """Return the configuration with single joints edited; raises AvatarSettingsError.

    Parts that are not named, or that the model lacks, stay unchanged.
    """
    axes = dict(configuration.axes)
    present = set(configuration.parts)
    for joint in joints:
        if joint.part in present:
            axes.update(edited(joint, axes))
    return replace(configuration, axes=axes)


def joined(configuration: Configuration, parts: Iterable[str]) -> Configuration:
    """Return the configuration as the single template has it, for some parts.

    Their limits and drives become those of their single joints, so that converting them back
    gives the same. What the single template cannot hold is lost. Raises AvatarSettingsError.
    """
    axes = dict(configuration.axes)
    present = set(configuration.parts)
    for part in parts:
        if part in present:
            axes.update(to_multiple(to_single(part, axes)))
    return replace(configuration, axes=axes)


def split(configuration: Configuration, joints: Iterable[SingleJoint]) -> Configuration:
    """Return the configuration with the axes of some parts made from single joints.

    Unlike `with_single_template`, this keeps nothing of what the axes were: every symmetric limit
    L becomes [-L, L]. Parts that the model lacks are passed over. Raises AvatarSettingsError.
    """
    axes = dict(configuration.axes)
    present = set(configuration.parts)
    for joint in joints:
        if joint.part in present:
            axes.update(to_multiple(joint))
    return replace(configuration, axes=axes)


def _with_limit(settings: AxisSettings, limit: float) -> AxisSettings:
    low, high = settings.low_rad, settings.high_rad
    if low == -high:
        low, high = -limit, limit
    elif abs(low) > abs(high):
        # The lower limit of a range on one side of the T-pose must stay below the upper one.
        low, high = -limit, max(high, -limit)
    else:
        low, high = min(low, limit), limit
    return replace(settings, low_rad=low, high_rad=high)


def _driven(drive: Drive, low_rad: float, high_rad: float) -> AxisSettings:
    return AxisSettings(drive.kp, drive.kd, drive.max_torque_nm, low_rad, high_rad)


def _drive(settings: AxisSettings) -> Drive:
    return Drive(settings.kp, settings.kd, settings.max_torque_nm)


def _stiffest(shared: list[AxisSettings]) -> Drive | None:
    drives = [_drive(settings) for settings in shared]
    return max(drives, key=lambda one: (one.kp, one.kd, one.max_torque_nm), default=None)


def _joint_problem(joint: SingleJoint, others: tuple[str, ...]) -> AvatarProblem | None:
    if set(joint.limits_rad) == set(others) and (joint.shared_drive is None) != (not others):
        return AvatarProblem(
            "shared_drive",
            f"The drives do not match the axes of {joint.part}: "
            + (f"the one that {', '.join(others)} share is missing." if others else "it has one."),
            value=None if others else "a shared drive",
            valid="a drive" if others else "no shared drive",
            remedy="Add it." if others else "Leave the shared drive out.",
        )
    if set(joint.limits_rad) != set(others) or (joint.shared_drive is None) != (not others):
        return AvatarProblem(
            "limits_rad",
            f"The given limits do not match the axes of {joint.part} that share a drive.",
            value=sorted(joint.limits_rad),
            valid=list(others),
            remedy="Give one limit for each of these axes, and a shared drive if there is one.",
        )
    negative = next((name for name in others if not joint.limits_rad[name] >= 0.0), None)
    if negative is None:
        return None
    return AvatarProblem(
        f"limits_rad.{negative}",
        f"A symmetric limit cannot be {degrees_of(joint.limits_rad[negative]):g} deg.",
        value=degrees_of(joint.limits_rad[negative]),
        valid="zero or more",
        remedy="Give the angle by which it turns in either direction.",
    )
