"""Operations on the axes of body parts: gains, limits, the single template, and both sides."""

from dataclasses import replace
from math import radians
from typing import Annotated, Literal

from pydantic import Field

from app.protocol.avatar import (
    AxisFile,
)
from app.protocol.avatar_changes import AxisName
from app.protocol.avatar_editing.operation import (
    Amount,
    Angle,
    Aspects,
    AvatarOperation,
    Factor,
    Groups,
    Half,
    Targets,
    present_axes,
    present_parts,
    problem,
    require_values,
)
from app.protocol.avatar_joints import DrivenPart, JointFile, joint_of
from app.protocol.common import Strict
from app.science.avatar.body import AXIS_NAMES, PART_NAMES
from app.science.avatar.configuration import (
    AvatarSettingsError,
    AxisSettings,
    Configuration,
    Direction,
    Motion,
    SingleJoint,
    joined,
    mirrored,
    shared_axes,
    split,
    to_single,
    with_axes,
    with_motion,
    with_single_template,
)


class SetGains(AvatarOperation):
    """Gains and greatest torque of axes: values, or factors of the present values."""

    operation: Literal["set_gains"]
    targets: Targets
    kp_nm_per_rad: Amount = None
    kd_nm_s_per_rad: Amount = None
    max_torque_nm: Amount = None
    kp_factor: Factor = None
    kd_factor: Factor = None
    max_torque_factor: Factor = None

    def applied(self, configuration: Configuration) -> Configuration:
        """Give every axis of the targets the values, or multiply what it has."""
        rows = (
            ("kp", "kp_nm_per_rad", self.kp_nm_per_rad, "kp_factor", self.kp_factor),
            ("kd", "kd_nm_s_per_rad", self.kd_nm_s_per_rad, "kd_factor", self.kd_factor),
            (
                "max_torque_nm", "max_torque_nm", self.max_torque_nm,
                "max_torque_factor", self.max_torque_factor,
            ),
        )  # fmt: skip
        for _, value_key, value, factor_key, factor in rows:
            if value is not None and factor is not None:
                raise problem(
                    factor_key,
                    "Both a value and a factor are given.",
                    value=factor,
                    valid=[value_key, factor_key],
                    remedy=f"Give {value_key} or {factor_key}, not both.",
                )
        require_values(self, {"operation", "targets"})

        def edit(_: str, settings: AxisSettings) -> AxisSettings:
            values: dict[str, float] = {}
            for field, _value_key, value, _factor_key, factor in rows:
                if value is not None:
                    values[field] = value
                elif factor is not None:
                    values[field] = factor * getattr(settings, field)
            return settings.with_values(**values)

        return with_axes(configuration, present_axes(configuration, self.targets), edit)


class SetLimits(AvatarOperation):
    """Lower and upper limit of axes; equal limits lock an axis."""

    operation: Literal["set_limits"]
    targets: Targets
    low_deg: Angle = None
    high_deg: Angle = None

    def applied(self, configuration: Configuration) -> Configuration:
        """Give every axis of the targets these limits; a limit left out stays."""
        require_values(self, {"operation", "targets"})
        values = {
            key: radians(angle)
            for key, angle in (("low_rad", self.low_deg), ("high_rad", self.high_deg))
            if angle is not None
        }
        return with_axes(
            configuration,
            present_axes(configuration, self.targets),
            lambda _, settings: settings.with_values(**values),
        )


class SetMotion(AvatarOperation):
    """How axes may turn: `locked`, `limited` as in a human body, or `free` over the full circle."""

    operation: Literal["set_motion"]
    targets: Targets
    motion: Motion

    def applied(self, configuration: Configuration) -> Configuration:
        """Set the limits of every axis of the targets."""
        return with_motion(configuration, present_axes(configuration, self.targets), self.motion)


class SetAxes(AvatarOperation):
    """Complete settings of single axes, such as those of an accepted tuning."""

    operation: Literal["set_axes"]
    axes: Annotated[dict[AxisName, AxisFile], Field(min_length=1, max_length=len(AXIS_NAMES))]

    def applied(self, configuration: Configuration) -> Configuration:
        """Replace the settings of these axes."""
        present_axes(configuration, self.axes)
        return with_axes(
            configuration,
            self.axes,
            lambda name, _: AxisSettings(
                self.axes[name].kp_nm_per_rad,
                self.axes[name].kd_nm_s_per_rad,
                self.axes[name].max_torque_nm,
                radians(self.axes[name].low_deg),
                radians(self.axes[name].high_deg),
            ),
        )


class DriveEdit(Strict):
    """Values of a drive in the single template; what is left out stays."""

    kp_nm_per_rad: Amount = None
    kd_nm_s_per_rad: Amount = None
    max_torque_nm: Amount = None


class EditJoint(AvatarOperation):
    """Edit parts in the single template, with one joint each.

    `low_deg`, `high_deg` and `drive` are of the primary axis; `limits_deg` are the symmetric limits
    of the other axes by their letters, and `shared_drive` is their drive. Only what is given
    changes: a symmetric limit replaces the limit that lies further from the T-pose.
    """

    operation: Literal["edit_joint"]
    targets: Groups
    low_deg: Angle = None
    high_deg: Angle = None
    limits_deg: Annotated[
        dict[Literal["X", "Y", "Z"], Half], Field(default_factory=dict, max_length=3)
    ]
    drive: DriveEdit | None = None
    shared_drive: DriveEdit | None = None

    def applied(self, configuration: Configuration) -> Configuration:
        """Edit the joint of every part of the targets."""
        require_values(self, {"operation", "targets"})
        parts = present_parts(configuration, self.targets)
        letters = {name[-1] for part in parts for name in shared_axes(part)}
        for letter in self.limits_deg:
            if letter not in letters:
                raise problem(
                    f"limits_deg.{letter}",
                    f"No axis {letter} of these parts has a symmetric limit.",
                    value=letter,
                    valid=sorted(letters),
                    remedy="Use low_deg and high_deg for the primary axis.",
                )
        return with_single_template(
            configuration, [self._edited(to_single(one, configuration.axes)) for one in parts]
        )

    def _edited(self, joint: SingleJoint) -> SingleJoint:
        limits = {
            name: radians(self.limits_deg[letter]) if letter in self.limits_deg else limit
            for name, limit in joint.limits_rad.items()
            for letter in _letters(name)
        }
        shared = joint.shared_drive
        try:
            return replace(
                joint,
                low_rad=joint.low_rad if self.low_deg is None else radians(self.low_deg),
                high_rad=joint.high_rad if self.high_deg is None else radians(self.high_deg),
                limits_rad=limits,
                drive=replace(joint.drive, **_drive_values(self.drive)),
                shared_drive=None
                if shared is None
                else replace(shared, **_drive_values(self.shared_drive)),
            )
        except AvatarSettingsError as error:
            raise AvatarSettingsError(
                tuple(one.prefixed(f"joints.{joint.part}") for one in error.problems)
            ) from None


class SetJoints(AvatarOperation):
    """Load joints of the single template.

    `edit` changes only what differs, as an edit of the single template does; `split` makes the axes
    anew, each symmetric limit L as [-L, L].
    """

    operation: Literal["set_joints"]
    joints: Annotated[dict[DrivenPart, JointFile], Field(min_length=1, max_length=len(PART_NAMES))]
    rule: Literal["edit", "split"] = "split"

    def applied(self, configuration: Configuration) -> Configuration:
        """Give these parts the axes of their joints."""
        present_parts(configuration, self.joints)
        joints = [joint_of(part, file) for part, file in self.joints.items()]
        change = split if self.rule == "split" else with_single_template
        return change(configuration, joints)


class ConvertTemplate(AvatarOperation):
    """Convert parts to the single template, or to the multiple one.

    `single` gives the axes the values that one joint per part can hold, and loses the others.
    `multiple` loses nothing: a configuration has the limits and gains of each axis, and those of a
    single template are [-L, L] and the shared drive already.
    """

    operation: Literal["convert"]
    to: Literal["single", "multiple"]
    targets: Groups = ("all",)

    def applied(self, configuration: Configuration) -> Configuration:
        """Convert every part of the targets."""
        parts = present_parts(configuration, self.targets)
        return joined(configuration, parts) if self.to == "single" else configuration


class Mirror(AvatarOperation):
    """Copy one side of the body to the other, or exchange both sides with `swap`."""

    operation: Literal["mirror"]
    direction: Direction
    targets: Groups = ("all",)
    what: Aspects = ("gains", "limits")

    def applied(self, configuration: Configuration) -> Configuration:
        """Copy what is asked for, of the parts of the targets and their counterparts."""
        return mirrored(configuration, self.direction, group=self.targets, aspects=self.what)


def _drive_values(edit: DriveEdit | None) -> dict[str, float]:
    if edit is None:
        return {}
    given = {
        "kp": edit.kp_nm_per_rad, "kd": edit.kd_nm_s_per_rad, "max_torque_nm": edit.max_torque_nm,
    }  # fmt: skip
    return {name: value for name, value in given.items() if value is not None}


def _letters(axis: str) -> tuple[Literal["X", "Y", "Z"], ...]:
    return tuple(letter for letter in ("X", "Y", "Z") if axis.endswith(letter))
