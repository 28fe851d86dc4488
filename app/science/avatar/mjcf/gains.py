"""Gains and greatest torques for a start, from what each axis has to move.

With I the moment of inertia that a motor turns (limb and armature, see `hinges`), an axis alone is
a critically damped oscillator of natural frequency w:

    kp = w^2 I,    kd = 2 w I,    w = 2 pi f.

The lighter a part, the higher its f: the weight of a limb of length l bends it by some g / (w^2 l).
The trunk has the lowest: between two free neighbours a joint of the spine moves only a hundredth of
I, and swings ten times as fast as f.

The greatest torques are of the order of what strong people can exert, doubled. They hardly bind
while a person is followed, as people have no more, but they bound what a jump of the target does.

Frequencies and torques are estimates. Measured tuning (relay experiments) replaces the gains.

`default_configuration` comes with the product. Limits are a human body's; gains and torques follow
from what each axis moves in a body of average stature and mass. A relay tuning finds better ones
for a certain body, and is saved beside this.
"""

from collections.abc import Mapping
from math import pi
from types import MappingProxyType
from typing import Final

from app.science.avatar.body import FINGER_PARTS, Body, BodyMasses, body_masses, build_body
from app.science.avatar.configuration import (
    USUAL_MASS_KG,
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
"""f of each part's axes; `Finger` is all of them."""
MAX_TORQUES_NM: Mapping[str, float] = MappingProxyType(
    {
        **dict.fromkeys(("Spine", "Chest", "UpperChest"), 500.0),
        **dict.fromkeys(("Neck", "Head"), 60.0),
        "UpperArm": 150.0, "LowerArm": 100.0, "Hand": 25.0, "Finger": 5.0,
        "UpperLeg": 400.0, "LowerLeg": 350.0, "Foot": 250.0, "Toes": 30.0,
    }
)  # fmt: skip
"""Of each part's axes; `Finger` is all of them."""


def default_settings(
    body: Body, masses: BodyMasses, *, preset: Preset = "anatomic"
) -> dict[str, AxisSettings]:
    """Return settings for every axis of the present parts, axis name -> settings."""
    limits = limits_of(preset)
    found: dict[str, AxisSettings] = {}
    for axis, hinge in hinges_of(body, masses).items():
        kind = _kind(axis)
        omega = 2.0 * pi * NATURAL_HZ[kind]
        found[axis] = AxisSettings(
            kp=_settled(omega**2 * hinge.inertia_kg_m2),
            kd=_settled(2.0 * omega * hinge.inertia_kg_m2),
            max_torque_nm=MAX_TORQUES_NM[kind],
            low_rad=limits[axis].low_rad,
            high_rad=limits[axis].high_rad,
        )
    return found


def _kind(axis: str) -> str:
    part = axis[:-1]
    if part in FINGER_PARTS:
        return "Finger"
    return part.removeprefix("Left").removeprefix("Right")


def _settled(value: float) -> float:
    """Six digits: as many as a person may want to read."""
    return float(f"{value:.6g}")


USUAL_STATURE_M: Final = 1.75


def default_configuration(*, limits: Preset = "anatomic") -> Configuration:
    """Every axis of the whole body; `free` lets the elbow turn about its third axis."""
    body = build_body(USUAL_STATURE_M)
    masses = body_masses(body, USUAL_MASS_KG)
    return Configuration(default_settings(body, masses, preset=limits))
