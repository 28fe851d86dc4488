"""Right-handed coordinate frames from directions, for each frame of a movement.

A frame is (N, 3, 3) with its x, y, z axes in the world as columns: in the T-pose, x points to the
body's right, y up and z to its back. It is NaN where the directions do not define a frame.
"""

from typing import Literal

import numpy as np

from app.science.rig import BoolArray
from app.science.rotations import FloatArray

Axis = Literal["x", "y", "z"]
_SHORTEST_M = 1e-4
_INDEX: dict[Axis, int] = {"x": 0, "y": 1, "z": 2}
UP: FloatArray = np.array((0.0, 1.0, 0.0))


def unit(vectors: FloatArray) -> FloatArray:
    """Scale vectors to length one; NaN where a vector is too short to have a direction."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > _SHORTEST_M, length, np.nan)


def dot(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the scalar product over the last axis."""
    product: FloatArray = np.einsum("...i,...i->...", a, b)
    return product


def frame(first: Axis, along: FloatArray, second: Axis, near: FloatArray) -> FloatArray:
    """Return frames whose `first` axis points `along` and whose `second` is closest to `near`."""
    a = unit(along)
    b = near - dot(near, a)[..., np.newaxis] * a
    b = unit(b)
    out = np.empty((*a.shape, 3))
    i, j = _INDEX[first], _INDEX[second]
    k = 3 - i - j
    out[..., i], out[..., j] = a, b
    # Cyclic order of x, y and z gives +, the opposite order -.
    sign = 1.0 if (i, j) in {(0, 1), (1, 2), (2, 0)} else -1.0
    out[..., k] = sign * np.cross(a, b)
    return out


def in_frame(axes: FloatArray, vectors: FloatArray) -> FloatArray:
    """Return the components of world vectors (..., 3) along a frame's axes."""
    components: FloatArray = np.einsum(
        "...ij,...i->...j", axes, np.broadcast_to(vectors, axes.shape[:-1])
    )
    return components


def to_world(axes: FloatArray, components: FloatArray) -> FloatArray:
    """Return world vectors from their components along a frame's axes, (..., 3) or (3,)."""
    vectors: FloatArray = np.einsum(
        "...ij,...j->...i", axes, np.broadcast_to(components, axes.shape[:-1])
    )
    return vectors


def levelled(axes: FloatArray, upright: BoolArray) -> FloatArray:
    """Tilt a frame about its own x axis by a constant, so that it is level in the `upright` frames.

    Markers are seldom level on the body: a head band slopes, a heel marker is lower than a toe
    marker. The median direction of up in these frames is taken as the T-pose's up.
    """
    up = in_frame(axes, UP)[upright & np.isfinite(axes).all(axis=(-1, -2))]
    if len(up) == 0:
        return axes
    _, y, z = np.median(up, axis=0)
    angle = float(np.arctan2(z, y))
    cosine, sine = np.cos(angle), np.sin(angle)
    tilt = np.array(((1.0, 0.0, 0.0), (0.0, cosine, -sine), (0.0, sine, cosine)))
    tilted: FloatArray = axes @ tilt
    return tilted


def highest(values: FloatArray, share: float = 0.2) -> BoolArray:
    """Return a mask of the frames with the largest finite values, the given share of all."""
    finite = values[np.isfinite(values)]
    if len(finite) == 0:
        none: BoolArray = np.zeros(len(values), np.bool_)
        return none
    marked: BoolArray = values >= np.quantile(finite, 1.0 - share)
    return marked


def across(
    a: FloatArray, along_a: FloatArray | float, b: FloatArray, along_b: FloatArray | float
) -> FloatArray:
    """Return the unit vectors n with n.a = along_a and n.b = along_b, on the side of a x b.

    n = s a + t b + u (a x b) solves the two equations for s and t, and length one gives u. NaN
    where a and b are parallel or no unit vector satisfies both equations.
    """
    aa, bb, ab = dot(a, a), dot(b, b), dot(a, b)
    determinant = aa * bb - ab**2
    safe = np.where(determinant > 1e-12 * aa * bb, determinant, np.nan)
    s, t = (along_a * bb - along_b * ab) / safe, (along_b * aa - along_a * ab) / safe
    rest = 1.0 - (s * along_a + t * along_b)
    u = np.sqrt(np.where(rest > 0.0, rest, np.nan) / safe)
    normal = np.cross(a, b)
    out: FloatArray = s[..., None] * a + t[..., None] * b + u[..., None] * normal
    return out


def median_distance(a: FloatArray, b: FloatArray) -> float:
    """Return the median distance over the frames that have both points; NaN if there are none."""
    lengths = np.linalg.norm(a - b, axis=-1)
    lengths = lengths[np.isfinite(lengths)]
    return float(np.median(lengths)) if len(lengths) else float("nan")
