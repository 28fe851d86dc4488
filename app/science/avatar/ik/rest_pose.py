"""The pose that inverse kinematics prefers where the goals leave a choice.

Knees and elbows are bent a little. A straight limb cannot get shorter by a small turn of its joint,
so from the T-pose a solver that looks at small turns only finds no way to bend it.
"""

from collections.abc import Mapping
from math import radians
from types import MappingProxyType

from app.science.avatar.body import SIDES

KNEE_DEG, ELBOW_DEG = 25.0, 30.0
REST_POSE_RAD: Mapping[str, float] = MappingProxyType(
    {
        axis: radians(angle)
        for side in SIDES
        for axis, angle in ((f"{side}LowerLegX", KNEE_DEG), (f"{side}LowerArmY", ELBOW_DEG))
    }
)
"""Axis -> its angle at rest; every other axis rests at zero, as in the T-pose."""
