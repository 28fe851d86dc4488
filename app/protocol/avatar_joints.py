"""Read and write the single template: one joint per body part, as game engines have it.

A part's primary axis has a lower and an upper limit and a drive; its other axes have one symmetric
limit each and share a drive (app.science.avatar.configuration.templates).
"""

from dataclasses import replace
from math import radians
from typing import Annotated

from pydantic import AfterValidator, Field, StringConstraints

from app.protocol.common import Strict, refusal
from app.science.avatar.body import AXES_OF, PART_NAMES
from app.science.avatar.configuration import (
    AvatarProblem,
    AvatarSettingsError,
    AxisSettings,
    Configuration,
    Drive,
    SingleJoint,
    degrees_of,
    primary_axis,
    single_template,
    to_multiple,
)


def _driven_part(name: str) -> str:
    if not AXES_OF.get(name):
        raise refusal(
            f"{name!r} is not a driven body part.",
            value=name,
            valid=[part for part in PART_NAMES if AXES_OF[part]],
            remedy="Name a driven part, as in LeftUpperLeg.",
        )
    return name


DrivenPart = Annotated[
    str, StringConstraints(min_length=1, max_length=40), AfterValidator(_driven_part)
]
_Angle = Annotated[float, Field(ge=-180, le=180, description="degrees from the T-pose")]
_Half = Annotated[float, Field(ge=0, le=180, description="degrees to either side of the T-pose")]


class DriveFile(Strict):
    """Stiffness, damping and greatest torque of a drive."""

    kp_nm_per_rad: Annotated[float, Field(ge=0, le=1e6, description="spring, N m per radian")]
    kd_nm_s_per_rad: Annotated[float, Field(ge=0, le=1e6, description="damper, N m s per radian")]
    max_torque_nm: Annotated[float, Field(ge=0, le=1e6, description="greatest torque, N m")]


class JointFile(Strict):
    """The one joint of a body part in the single template.

    `low_deg`, `high_deg`, `drive`: those of the primary axis. `limits_deg`: the name of each other
    axis -> its symmetric limit. `shared_drive`: the drive of the other axes, if there are any.
    """

    low_deg: _Angle
    high_deg: _Angle
    drive: DriveFile
    limits_deg: Annotated[dict[str, _Half], Field(max_length=2)]
    shared_drive: DriveFile | None = None


class JointView(JointFile):
    """A joint of the single template with the name of its primary axis."""

    primary_axis: str


def joint_of(part: str, file: JointFile) -> SingleJoint:
    """Convert a file to a joint; raise AvatarSettingsError, with paths below `joints`."""
    try:
        return SingleJoint(
            part=part,
            low_rad=radians(file.low_deg),
            high_rad=radians(file.high_deg),
            drive=_drive_of(file.drive),
            limits_rad={name: radians(limit) for name, limit in file.limits_deg.items()},
            shared_drive=None if file.shared_drive is None else _drive_of(file.shared_drive),
        )
    except AvatarSettingsError as error:
        raise AvatarSettingsError(tuple(_in_file(part, one) for one in error.problems)) from None


def axes_of_joint(part: str, file: JointFile) -> dict[str, AxisSettings]:
    """Split a joint into the axes of its part; raise AvatarSettingsError like `joint_of`."""
    joint = joint_of(part, file)
    try:
        return to_multiple(joint)
    except AvatarSettingsError as error:
        raise AvatarSettingsError(
            tuple(one.prefixed(f"joints.{part}") for one in error.problems)
        ) from None


def joint_files(configuration: Configuration) -> dict[str, JointFile]:
    """Return every driven part of a configuration as one joint."""
    return {part: _file(joint) for part, joint in single_template(configuration).items()}


def joint_views(configuration: Configuration) -> dict[str, JointView]:
    """Return every driven part as one joint, with the name of its primary axis."""
    return {
        part: JointView(**file.model_dump(), primary_axis=primary_axis(part))
        for part, file in joint_files(configuration).items()
    }


def _in_file(part: str, problem: AvatarProblem) -> AvatarProblem:
    """Return a problem of a joint with the path that its value has in the file, in degrees."""
    path = problem.path.replace("limits_rad", "limits_deg")
    return replace(problem, path=path).prefixed(f"joints.{part}")


def _file(joint: SingleJoint) -> JointFile:
    return JointFile(
        low_deg=degrees_of(joint.low_rad),
        high_deg=degrees_of(joint.high_rad),
        drive=_drive_file(joint.drive),
        limits_deg={name: degrees_of(limit) for name, limit in joint.limits_rad.items()},
        shared_drive=None if joint.shared_drive is None else _drive_file(joint.shared_drive),
    )


def _drive_of(file: DriveFile) -> Drive:
    return Drive(file.kp_nm_per_rad, file.kd_nm_s_per_rad, file.max_torque_nm)


def _drive_file(drive: Drive) -> DriveFile:
    return DriveFile(
        kp_nm_per_rad=drive.kp, kd_nm_s_per_rad=drive.kd, max_torque_nm=drive.max_torque_nm
    )
