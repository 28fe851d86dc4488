"""Compute initial gains and torque limits from the inertia that each axis moves.

With I the moment of inertia that a motor turns (limb and armature, see `hinges`), an axis alone is
a critically damped oscillator of natural frequency w:

    kp = w^2 I,    kd = 2 w I,    w = 2 pi f.

Lighter parts get a higher f: the weight of a limb of length l deflects it by an angle of about g /
(w^2 l). The trunk has the lowest f: between two free neighbours, a joint of the spine moves only a
hundredth of I and oscillates ten times as fast as f.

The torque limits are about twice what strong people can exert. They are rarely reached while the
avatar follows a person, who has no more torque than that, but they bound the response to a jump of
the target.

Frequencies and torques are estimates. Measured tuning (relay experiments) replaces the gains.

`default_configuration` is the configuration that Reembody ships with. Its limits are those of a
human body; gains and torques follow from what each axis moves in a body of average stature and
mass. A relay tuning finds better ones for a particular body, and is saved as a separate
configuration.
"""

from collections.abc import Mapping
from math import pi
from types import MappingProxyType
from typing import Final

from app.science.avatar.body import FINGER_PARTS, Body, BodyMasses, body_masses, build_body
from app.science.avatar.configuration import (
    DEFAULT_MASS_KG,
    AxisSettings,
    Configuration,
    Preset,
    limits_of,
)
from app.science.avatar.mjcf.hinges import hinges_of

NATURAL_HZ: Mapping[str, float] = MappingProxyType(
    {
        **dict.fromkeys(("Spine", "Chest", "UpperChest"), 6.0),
        **dict.fromkeys(("Neck", "Head", "UpperArm", "UpperLeg", "LowerLeg"), 10.0),
        **dict.fromkeys(("LowerArm", "Foot"), 12.0),
        **dict.fromkeys(("Hand", "Toes", "Finger"), 15.0),
    }
)
"""Natural frequency f of each part's axes, in Hz; `Finger` stands for all finger parts."""
MAX_TORQUES_NM: Mapping[str, float] = MappingProxyType(
    {
        **dict.fromkeys(("Spine", "Chest", "UpperChest"), 500.0),
        **dict.fromkeys(("Neck", "Head"), 60.0),
        "UpperArm": 150.0, "LowerArm": 100.0, "Hand": 25.0, "Finger": 5.0,
        "UpperLeg": 400.0, "LowerLeg": 350.0, "Foot": 250.0, "Toes": 30.0,
    }
)  # fmt: skip
"""Torque limit of each part's axes; `Finger` stands for all finger parts."""


def default_settings(
    body: Body, masses: BodyMasses, *, preset: Preset = "anatomic"
) -> dict[str, AxisSettings]:
    """Return the default settings of every axis of the parts of `body`, by axis name."""
    limits = limits_of(preset)
    settings: dict[str, AxisSettings] = {}
    for axis, hinge in hinges_of(body, masses).items():
        kind = _kind(axis)
        omega = 2.0 * pi * NATURAL_HZ[kind]
        settings[axis] = AxisSettings(
            kp=_rounded(omega**2 * hinge.inertia_kg_m2),
            kd=_rounded(2.0 * omega * hinge.inertia_kg_m2),
            max_torque_nm=MAX_TORQUES_NM[kind],
            low_rad=limits[axis].low_rad,
            high_rad=limits[axis].high_rad,
        )
    return settings


def _kind(axis: str) -> str:
    part = axis[:-1]
    if part in FINGER_PARTS:
        return "Finger"
    return part.removeprefix("Left").removeprefix("Right")


def _rounded(value: float) -> float:
    """Round to six significant digits, so that gains stay readable."""
    return float(f"{value:.6g}")


USUAL_STATURE_M: Final = 1.75


def default_configuration(*, limits: Preset = "anatomic") -> Configuration:
    """Return the configuration of the whole body that Reembody ships with.

    The preset `free` of the limits lets the elbow turn about its third axis.
    """
    body = build_body(USUAL_STATURE_M)
    masses = body_masses(body, DEFAULT_MASS_KG)
    return Configuration(default_settings(body, masses, preset=limits))
