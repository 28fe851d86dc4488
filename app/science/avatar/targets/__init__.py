"""From a pose to the angles that the motors are asked for.

`TargetAngles` follows poses frame by frame or as a recording, within limits and without;
`joint_rotations` is the way back. `HingeReference` says what an avatar's joints were asked for, the
reference from which joint errors are counted.
"""

from app.science.avatar.targets.hinge_reference import HingeReference
from app.science.avatar.targets.targets import TargetAngles, Targets, joint_rotations

__all__ = [
    "HingeReference",
    "TargetAngles",
    "Targets",
    "joint_rotations",
]
