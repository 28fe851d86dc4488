"""Locked axes as part of a body's place: what a cast does to the hinges around it.

A part's rotation is a product of turns about its axes, R1 R2 R3. A locked axis is a constant L in
it. As R(a, q) L = L R(L^-1 a, q), all constants can stand in front, where they turn the whole body,
if each axis that stood before one is turned back by it.
"""

from collections.abc import Sequence
from math import cos, sin

from app.science.avatar.body import Axis
from app.science.rotations import IDENTITY, Quaternion, Vector, q_multiply, q_rotate


def with_locks(
    axes: Sequence[Axis], locked_rad: Sequence[float | None]
) -> tuple[Quaternion, list[tuple[Axis, Vector]]]:
    """Return the turn of all locked axes, and each other axis with its direction behind that turn.

    Args:
        axes: of one part, outermost first.
        locked_rad: for each, the angle it is locked at; None where it turns.
    """
    turn: Quaternion = IDENTITY
    turning: list[tuple[Axis, Vector]] = []
    for axis, angle in zip(axes, locked_rad, strict=True):
        if angle is None:
            turning.append((axis, axis.direction))
        elif angle != 0.0:
            turn = q_multiply(turn, _about(axis.direction, angle))
            back = _about(axis.direction, -angle)
            turning = [(before, q_rotate(back, way)) for before, way in turning]
    return turn, turning


def _about(direction: Vector, angle: float) -> Quaternion:
    x, y, z = direction
    half = sin(angle / 2.0)
    return (cos(angle / 2.0), x * half, y * half, z * half)
