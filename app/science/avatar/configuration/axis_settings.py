"""Define how one axis of the avatar is driven, and how far it turns.

A driven axis is a hinge with a motor. At angle q and speed q', the motor pulls towards a target
angle and speed with the torque

    kp (target - q) + kd (target speed - q'),   at most max_torque_nm in either direction,

and the hinge turns from `low_rad` to `high_rad`, counted from the T-pose. An axis whose two limits
are equal is locked: it stays at that angle and is neither driven nor tuned.

Source: Karas (2020), section 2.2.5: spring, damper and maximum force of an angular drive.
"""

import math
from dataclasses import dataclass, replace
from typing import Any, Final

MAX_ANGLE_RAD: Final = math.pi
MAX_KP_NM_PER_RAD: Final = 1e6
MAX_KD_NM_S_PER_RAD: Final = 1e6
MAX_TORQUE_NM: Final = 1e6
_DECIMALS_DEG = 9


@dataclass(frozen=True)
class AvatarProblem:
    """An invalid value in the settings of an avatar, and how to correct it.

    Attributes:
        path: the path to the value, such as `axes.LeftUpperLegX.kp_nm_per_rad`.
        message: a description of the problem.
        value: the given value.
        valid: a description of the valid values.
        remedy: the correction to make.
    """

    path: str
    message: str
    value: object = None
    valid: object = None
    remedy: str = ""

    def __str__(self) -> str:
        where = f"{self.path}: " if self.path else ""
        return f"{where}{self.message} {self.remedy}".rstrip()

    def prefixed(self, path: str) -> "AvatarProblem":
        """Return the problem with `path` in front of its own path."""
        return replace(self, path=f"{path}.{self.path}" if self.path else path)


class AvatarSettingsError(ValueError):
    """Settings of an avatar are invalid or inconsistent; `problems` lists all that is wrong."""

    def __init__(self, problems: tuple[AvatarProblem, ...]) -> None:
        self.problems = problems
        super().__init__("\n".join(str(problem) for problem in problems))


@dataclass(frozen=True)
class AxisSettings:
    """Gains, torque limit and joint limits of one axis.

    Angles are rounded to a billionth of a degree. So a file in degrees, which people read and
    write, stores them without loss, and equal settings have the same hash.

    Attributes:
        kp: stiffness, in N m per radian; zero or more.
        kd: damping, in N m s per radian; zero or more.
        max_torque_nm: the torque limit of the motor, in either direction; zero lets the limb hang.
        low_rad: lower limit, at least -pi.
        high_rad: upper limit, at most pi, and not below `low_rad`. Zero, the T-pose, need not lie
            between them.

    Raises:
        AvatarSettingsError: a value is invalid; the error lists all that are.
    """

    kp: float
    kd: float
    max_torque_nm: float
    low_rad: float
    high_rad: float

    def __post_init__(self) -> None:
        problems = tuple(
            problem
            for name, path, least, most in _RANGES
            if (problem := _number_problem(path, getattr(self, name), least, most)) is not None
        )
        if not problems and self.low_rad > self.high_rad:
            problems = (
                AvatarProblem(
                    "low_deg",
                    f"The lower limit, {math.degrees(self.low_rad):g} deg, lies above the upper"
                    f" one, {math.degrees(self.high_rad):g} deg.",
                    value=degrees_of(self.low_rad),
                    valid=f"at most {math.degrees(self.high_rad):g}",
                    remedy="Swap them, or make them equal to lock the axis.",
                ),
            )
        if problems:
            raise AvatarSettingsError(problems)
        for name in ("kp", "kd", "max_torque_nm"):
            object.__setattr__(self, name, float(getattr(self, name)) + 0.0)  # -0.0 becomes 0.0
        for name in ("low_rad", "high_rad"):
            object.__setattr__(self, name, rounded_angle(getattr(self, name)))

    @property
    def locked(self) -> bool:
        """Return whether the axis cannot turn."""
        return self.low_rad == self.high_rad

    @property
    def range_rad(self) -> float:
        """Return the angle from one limit to the other."""
        return self.high_rad - self.low_rad

    @property
    def rest_rad(self) -> float:
        """Return the permitted angle nearest to the T-pose's, at which a body starts."""
        return self.clamped(0.0)

    def clamped(self, angle_rad: float) -> float:
        """Return the permitted angle nearest to the given one."""
        return min(max(angle_rad, self.low_rad), self.high_rad)

    def locked_at(self, angle_rad: float) -> "AxisSettings":
        """Return the axis locked at the permitted angle nearest to the given one."""
        angle = self.clamped(angle_rad)
        return replace(self, low_rad=angle, high_rad=angle)

    def with_values(self, **values: Any) -> "AxisSettings":
        """Return a copy with some values changed, such as `with_values(kp=300.0)`."""
        return replace(self, **values)


def rounded_angle(angle_rad: float) -> float:
    """Round an angle in rad to a billionth of a degree, which a file in degrees stores exactly."""
    return math.radians(degrees_of(angle_rad))


def degrees_of(angle_rad: float) -> float:
    """Return the angle in degrees, rounded to a billionth."""
    return round(math.degrees(angle_rad), _DECIMALS_DEG) + 0.0


# Attribute, its key in a file, minimum and maximum in the attribute's unit.
_RANGES: tuple[tuple[str, str, float, float], ...] = (
    ("kp", "kp_nm_per_rad", 0.0, MAX_KP_NM_PER_RAD),
    ("kd", "kd_nm_s_per_rad", 0.0, MAX_KD_NM_S_PER_RAD),
    ("max_torque_nm", "max_torque_nm", 0.0, MAX_TORQUE_NM),
    ("low_rad", "low_deg", -MAX_ANGLE_RAD, MAX_ANGLE_RAD),
    ("high_rad", "high_deg", -MAX_ANGLE_RAD, MAX_ANGLE_RAD),
)


def _number_problem(path: str, value: float, least: float, most: float) -> AvatarProblem | None:
    if math.isfinite(value) and least <= value <= most:
        return None
    convert, unit = (degrees_of, " deg") if path.endswith("_deg") else (float, "")
    return AvatarProblem(
        path,
        f"{convert(value):g}{unit} is out of range."
        if math.isfinite(value)
        else "It is not finite.",
        value=convert(value),
        valid=f"from {convert(least):g} to {convert(most):g}{unit}",
        remedy=f"Give a number from {convert(least):g} to {convert(most):g}{unit}.",
    )
