"""Rotation vectors of single frames: how far one orientation is from another, and turning it."""

from math import atan2, cos, sin, sqrt

from app.science.rotations import Quaternion, Vector, q_multiply

_TINY = 1e-12


def rotation_between(current: Quaternion, goal: Quaternion) -> Vector:
    """Return the rotation vector, in the world, that turns `current` into `goal`; at most pi long.

    Both are world_from_part and need not be quite unit.
    """
    w, x, y, z = current
    dw, dx, dy, dz = q_multiply(goal, (w, -x, -y, -z))
    if dw < 0.0:
        dw, dx, dy, dz = -dw, -dx, -dy, -dz
    sine = sqrt(dx * dx + dy * dy + dz * dz)
    factor = 2.0 * atan2(sine, dw) / sine if sine > _TINY else 2.0
    return (factor * dx, factor * dy, factor * dz)


def turned(current: Quaternion, by: Vector) -> Quaternion:
    """Return `current` turned by a rotation vector in the world."""
    x, y, z = by
    angle = sqrt(x * x + y * y + z * z)
    half = sin(angle / 2.0) / angle if angle > _TINY else 0.5
    w, x, y, z = q_multiply((cos(angle / 2.0), half * x, half * y, half * z), current)
    scale = 1.0 / sqrt(w * w + x * x + y * y + z * z)
    return (w * scale, x * scale, y * scale, z * scale)
