"""The shortest turn from one direction to another, exact to rounding at every angle.

The half-vector form q ~ (1 + v.k, v x k) loses digits as v and k become opposite: 1 + v.k is then
a difference of almost equal numbers. Its sine and cosine of half the angle are here the lengths

    cos(a/2) = |v + k| / 2,   sin(a/2) = |v - k| / 2,

which are exact to rounding, and the axis v x k, made square to v. So v lands on k within a few
units of rounding also next to opposite, where arccos(v.k) is off by 5e-4 in single precision.
For v and k exactly opposite any axis across v would do; the caller may name one.
"""

import numpy as np

from app.science.rotations import FloatArray


def swing(start: FloatArray, end: FloatArray, across: FloatArray | None = None) -> FloatArray:
    """Return the rotation (4,) that brings the direction `start` onto `end`, both (3,).

    It computes in the precision it is given (float64 or float32). Directions need no unit length,
    only a length above zero. `across` is the axis of a half turn, at a right angle to `start`.
    """
    v, k = unit(start), unit(end)
    cosine = np.linalg.norm(v + k)
    sine = np.linalg.norm(v - k)
    return unit(np.concatenate(([cosine], sine * _axis(v, k, across))).astype(v.dtype))


def unit(vector: FloatArray) -> FloatArray:
    """Return the vector at length one, in its own precision."""
    scaled: FloatArray = vector / np.linalg.norm(vector)
    return scaled


def _axis(v: FloatArray, k: FloatArray, otherwise: FloatArray | None) -> FloatArray:
    across = np.cross(v, k)
    length = np.linalg.norm(across)
    square = across - v * np.dot(v, across)
    # Rounding alone may have made the product: half of it along v says so.
    if float(np.linalg.norm(square)) > 0.5 * float(length) > 0.0:
        return unit(square)
    if otherwise is not None:
        return unit(otherwise)
    least = np.zeros_like(v)
    least[np.argmin(np.abs(v))] = 1.0
    return unit(np.cross(v, least))
