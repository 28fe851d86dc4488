"""Compute the motors' target angles from a pose.

`TargetAngles` converts poses, frame by frame or as a recording, to angles, both clamped to the
limits and unclamped; `joint_rotations` is the inverse. `HingeReference` gives the rotations that
the motors of an avatar aimed at, the reference of joint errors.
"""

from app.science.avatar.targets.hinge_reference import HingeReference
from app.science.avatar.targets.limb_yield import LimbYield
from app.science.avatar.targets.targets import (
    Fingers,
    TargetAngles,
    Targets,
    finger_rotations,
    joint_rotations,
)

__all__ = [
    "Fingers",
    "HingeReference",
    "LimbYield",
    "TargetAngles",
    "Targets",
    "finger_rotations",
    "joint_rotations",
]
