"""How one axis of the avatar is driven, and how far it turns.

A driven axis is a hinge with a motor. At angle q and speed q', the motor pulls towards a target
angle and speed with the torque

    kp (target - q) + kd (target speed - q'),   at most max_torque_nm either way,

and the hinge turns from `low_rad` to `high_rad`, counted from the T-pose. An axis whose two limits
are one angle is locked: it stays at that angle and is neither driven nor tuned.

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
    """One thing to correct in the settings of an avatar.

    Attributes:
        path: to the value, such as `axes.LeftUpperLegX.kp_nm_per_rad`.
        message: what is wrong.
        value: what was given.
        valid: what could stand there.
        remedy: what to do.
    """

    path: str
    message: str
    value: object = None
    valid: object = None
    remedy: str = ""

    def __str__(self) -> str:
        where = f"{self.path}: " if self.path else ""
        return f"{where}{self.message} {self.remedy}".rstrip()

    def below(self, path: str) -> "AvatarProblem":
        """The same problem, told from further up."""
        return replace(self, path=f"{path}.{self.path}" if self.path else path)


class AvatarSettingsError(ValueError):
    """Settings of an avatar contradict themselves; `problems` are all of them."""

    def __init__(self, problems: tuple[AvatarProblem, ...]) -> None:
        self.problems = problems
        super().__init__("\n".join(str(problem) for problem in problems))


@dataclass(frozen=True)
class AxisSettings:
    """Gains, greatest torque and limits of one axis.

    Angles are kept to a billionth of a degree. So a file in degrees, which is what people read and
    write, holds them without loss, and equal settings have one hash.

    Attributes:
        kp: spring, in N m per radian; zero or more.
        kd: damper, in N m s per radian; zero or more.
        max_torque_nm: of the motor, either way; zero lets the limb hang.
        low_rad: least angle, at least half a turn back.
        high_rad: greatest angle, at most half a turn ahead, and not below `low_rad`. Zero, the
            T-pose, need not lie between them.

    Raises:
        AvatarSettingsError: with every value that cannot be.
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
                    value=math.degrees(self.low_rad),
                    valid=f"at most {math.degrees(self.high_rad):g}",
                    remedy="Exchange them, or make them equal to lock the axis.",
                ),
            )
        if problems:
            raise AvatarSettingsError(problems)
        for name in ("kp", "kd", "max_torque_nm"):
            object.__setattr__(self, name, float(getattr(self, name)) + 0.0)  # -0.0 becomes 0.0
        for name in ("low_rad", "high_rad"):
            object.__setattr__(self, name, settled_angle(getattr(self, name)))

    @property
    def locked(self) -> bool:
        """Whether the axis cannot turn."""
        return self.low_rad == self.high_rad

    @property
    def range_rad(self) -> float:
        """How far it turns from one limit to the other."""
        return self.high_rad - self.low_rad

    @property
    def rest_rad(self) -> float:
        """The allowed angle nearest to the T-pose's: where a body starts."""
        return self.clamped(0.0)

    def clamped(self, angle_rad: float) -> float:
        """The allowed angle nearest to the one asked for."""
        return min(max(angle_rad, self.low_rad), self.high_rad)

    def locked_at(self, angle_rad: float) -> "AxisSettings":
        """The same axis, locked at the allowed angle nearest to the one asked for."""
        angle = self.clamped(angle_rad)
        return replace(self, low_rad=angle, high_rad=angle)

    def with_values(self, **values: Any) -> "AxisSettings":
        """A copy with some values changed, such as `with_values(kp=300.0)`."""
        return replace(self, **values)


def settled_angle(angle_rad: float) -> float:
    """The angle to a billionth of a degree, which a file in degrees gives back to the bit."""
    return math.radians(degrees_of(angle_rad))


def degrees_of(angle_rad: float) -> float:
    """The angle in degrees, to a billionth."""
    return round(math.degrees(angle_rad), _DECIMALS_DEG) + 0.0


# Attribute, its key in a file, least and greatest value, in the attribute's unit.
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
    told, unit = (math.degrees, " deg") if path.endswith("_deg") else (float, "")
    return AvatarProblem(
        path,
        f"{told(value):g}{unit} is out of range." if math.isfinite(value) else "It is not finite.",
        value=told(value),
        valid=f"from {told(least):g} to {told(most):g}{unit}",
        remedy=f"Give a number from {told(least):g} to {told(most):g}{unit}.",
    )
