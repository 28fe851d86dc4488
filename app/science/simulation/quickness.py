"""How quickly a body can move, whatever its limbs are asked for.

Inverse kinematics has places where a small change of what is asked turns a joint by any angle at
once: an elbow or a knee that becomes straight, fingers along the arm's own axis. Muscles do not: a
joint turns there as quickly as a person's can, and is where it should be some frames later.
"""

from collections.abc import Sequence
from math import acos, cos, pi, radians

from app.science.rotations import Quaternion, q_slerp

MOST_TURN_RAD_PER_S = radians(1500.0)
"""Elbows and wrists of people who hurry reach 1300 deg/s."""
MOST_SINK_M_PER_S = 2.5
"""Hips that sink freely for a third of a second fall 3 m/s."""


def no_quicker(
    before: Sequence[Quaternion], wanted: Sequence[Quaternion], step_s: float
) -> list[Quaternion]:
    """Return the wanted local rotations, each only as far from the one before as it can have come.

    All quaternions have length 1. The shorter way is taken.
    """
    half_turn = 0.5 * MOST_TURN_RAD_PER_S * step_s
    near = cos(min(half_turn, 0.5 * pi))
    return [
        b if abs(cosine := _dot(a, b)) >= near else q_slerp(a, b, half_turn / acos(abs(cosine)))
        for a, b in zip(before, wanted, strict=True)
    ]


def _dot(a: Quaternion, b: Quaternion) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
