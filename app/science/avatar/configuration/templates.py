"""One joint a body part, or one joint an axis: the thesis's two templates, and the way between.

In the *multiple* template each axis of a part has limits, gains and a greatest torque of its own;
that is what a configuration holds. The *single* template has one joint a part, as game engines
do. Its primary axis has a lower and an upper limit and a drive; its other axes have one symmetric
limit each and one drive in common.

Single to multiple loses nothing: a symmetric limit L becomes [-L, L], and the common drive is
given to each of those axes. Multiple to single must choose:

- a symmetric limit is the greater of |low| and |high|, so every pose stays possible;
- the common drive is that of the stiffest axis (greatest kp, then kd, then torque; then the first
  in the part's order), taken whole, because a kp belongs to the kd it was tuned with.

An edit of the single template changes in the multiple one only what was edited. A new symmetric
limit goes to the side it came from, and the other side stays as it was; where both sides are
equally far, it goes to both. A new common drive goes to every axis that shares it.

Source: Karas (2020), sections 2.2.3, 4.2.3 and 6.3, which leaves the common drive and equal sides
open ("a compromise", chapter 8); those rules, and which axis is primary, are ours.
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
    settled_angle,
)
from app.science.avatar.configuration.configuration import Configuration

# The axis of a part's greatest and least symmetric movement; X where nothing is said.
_PRIMARY_LETTERS = {"UpperArm": "Y", "LowerArm": "Y", "Hand": "Z"}


@dataclass(frozen=True)
class Drive:
    """Spring, damper and greatest torque; units and ranges as in `AxisSettings`."""

    kp: float
    kd: float
    max_torque_nm: float


@dataclass(frozen=True)
class SingleJoint:
    """The one joint of a body part.

    Attributes:
        part: HumanBodyBones name of a driven part.
        low_rad: least angle about the primary axis.
        high_rad: greatest angle about it.
        drive: of the primary axis.
        limits_rad: other axis -> its symmetric limit, zero or more, in the part's order.
        shared_drive: of the other axes; None where there are none.

    Raises:
        AvatarSettingsError: a part that is not driven, other axes than the part's, no limit.
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
            object.__setattr__(self, name, settled_angle(getattr(self, name)))
        limits = {name: settled_angle(self.limits_rad[name]) for name in others}
        object.__setattr__(self, "limits_rad", MappingProxyType(limits))


def primary_axis(part: str) -> str:
    """The axis with limits and a drive of its own; raises AvatarSettingsError."""
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
    bare = part.removeprefix("Left").removeprefix("Right")
    letter = _PRIMARY_LETTERS.get(bare, "X")
    # Fingers have no X; their first axis bends them.
    return next((axis.name for axis in axes if axis.letter == letter), axes[0].name)


def shared_axes(part: str) -> tuple[str, ...]:
    """The axes with a symmetric limit and a drive in common; raises AvatarSettingsError."""
    primary = primary_axis(part)
    return tuple(axis.name for axis in AXES_OF[part] if axis.name != primary)


def to_multiple(joint: SingleJoint) -> dict[str, AxisSettings]:
    """The joint as one joint an axis; raises AvatarSettingsError where a value cannot be."""
    settings = {
        primary_axis(joint.part): _driven(joint.drive, joint.low_rad, joint.high_rad),
    }
    if joint.shared_drive is not None:
        for name, limit in joint.limits_rad.items():
            settings[name] = _driven(joint.shared_drive, -limit, limit)
    return {axis.name: settings[axis.name] for axis in AXES_OF[joint.part]}


def to_single(part: str, axes: Mapping[str, AxisSettings]) -> SingleJoint:
    """The part's axes as one joint. `axes` has all of them, others are not read."""
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
    """What the part's axes become when its single joint is edited to `joint`.

    Args:
        joint: as it is to be.
        axes: the part's axes as they are, from which the joint was seen.

    Raises:
        AvatarSettingsError: a value that cannot be.
    """
    seen = to_single(joint.part, axes)
    primary = primary_axis(joint.part)
    changed: dict[str, AxisSettings] = {
        primary: _driven(joint.drive, joint.low_rad, joint.high_rad)
    }
    for name in shared_axes(joint.part):
        settings = axes[name]
        if joint.limits_rad[name] != seen.limits_rad[name]:
            settings = _with_limit(settings, joint.limits_rad[name])
        if joint.shared_drive is not None and joint.shared_drive != seen.shared_drive:
            settings = _driven(joint.shared_drive, settings.low_rad, settings.high_rad)
        changed[name] = settings
    return {axis.name: changed[axis.name] for axis in AXES_OF[joint.part]}


def single_template(configuration: Configuration) -> dict[str, SingleJoint]:
    """Every driven part of the configuration as one joint."""
    return {part: to_single(part, configuration.axes) for part in configuration.parts}


def with_single_template(
    configuration: Configuration, joints: Iterable[SingleJoint]
) -> Configuration:
    """The configuration with single joints edited; parts that are not named, or that the model
    lacks, stay as they are. Raises AvatarSettingsError.
    """
    axes = dict(configuration.axes)
    present = set(configuration.parts)
    for joint in joints:
        if joint.part in present:
            axes.update(edited(joint, axes))
    return replace(configuration, axes=axes)


def _with_limit(settings: AxisSettings, limit: float) -> AxisSettings:
    low, high = settings.low_rad, settings.high_rad
    if low == -high:
        low, high = -limit, limit
    elif abs(low) > abs(high):
        # A range on one side of the T-pose must not turn inside out.
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
    if set(joint.limits_rad) != set(others) or (joint.shared_drive is None) != (not others):
        return AvatarProblem(
            "limits_rad",
            f"{joint.part} shares a drive and symmetric limits among other axes than these.",
            value=sorted(joint.limits_rad),
            valid=list(others),
            remedy="Give one limit for each of these axes, and a shared drive if there is one.",
        )
    below = next((name for name in others if not joint.limits_rad[name] >= 0.0), None)
    if below is None:
        return None
    return AvatarProblem(
        f"limits_rad.{below}",
        f"A symmetric limit of {degrees_of(joint.limits_rad[below]):g} deg is not one.",
        value=degrees_of(joint.limits_rad[below]),
        valid="zero or more",
        remedy="Give how far it turns either way.",
    )
