"""Right-handed frames from directions, frame by frame; NaN where the directions give none.

A frame is (N, 3, 3) with its x, y, z axes in the world as columns: x to the body's right, y up
and z to its back in the T-pose.
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
    """Scale to length one, NaN where there is no direction."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > _SHORTEST_M, length, np.nan)


def dot(a: FloatArray, b: FloatArray) -> FloatArray:
    """Scalar product over the last axis."""
    product: FloatArray = np.einsum("...i,...i->...", a, b)
    return product


def frame(first: Axis, along: FloatArray, second: Axis, near: FloatArray) -> FloatArray:
    """The frame whose `first` axis points `along` and whose `second` is as `near` as it can be."""
    a = unit(along)
    b = near - dot(near, a)[..., np.newaxis] * a
    b = unit(b)
    out = np.empty((*a.shape, 3))
    i, j = _INDEX[first], _INDEX[second]
    k = 3 - i - j
    out[..., i], out[..., j] = a, b
    # x y z in circle gives +, against it -.
    sign = 1.0 if (i, j) in {(0, 1), (1, 2), (2, 0)} else -1.0
    out[..., k] = sign * np.cross(a, b)
    return out


def in_frame(axes: FloatArray, vectors: FloatArray) -> FloatArray:
    """World vectors (..., 3) by their components along a frame's axes."""
    told: FloatArray = np.einsum(
        "...ij,...i->...j", axes, np.broadcast_to(vectors, axes.shape[:-1])
    )
    return told


def to_world(axes: FloatArray, components: FloatArray) -> FloatArray:
    """Components along a frame's axes, (..., 3) or (3,), as world vectors."""
    told: FloatArray = np.einsum(
        "...ij,...j->...i", axes, np.broadcast_to(components, axes.shape[:-1])
    )
    return told


def levelled(axes: FloatArray, upright: BoolArray) -> FloatArray:
    """Tilt a frame about its own x by a constant, so that in `upright` frames it stands level.

    Markers seldom sit level on the body: a head band slopes, a heel marker is lower than a toe
    marker. What is upright in the median of those frames is what the T-pose calls upright.
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
    """Mark the frames with the largest finite values, the given share of them."""
    finite = values[np.isfinite(values)]
    if len(finite) == 0:
        none: BoolArray = np.zeros(len(values), np.bool_)
        return none
    marked: BoolArray = values >= np.quantile(finite, 1.0 - share)
    return marked


def across(
    a: FloatArray, along_a: FloatArray | float, b: FloatArray, along_b: FloatArray | float
) -> FloatArray:
    """The unit vectors n with n.a = along_a and n.b = along_b, on the side of a x b.

    n = s a + t b + u (a x b) solves the two equations for s and t, and length one gives u. NaN
    where a and b are parallel or ask for more than length one.
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
    """Median distance over the frames that have both, NaN where none has."""
    lengths = np.linalg.norm(a - b, axis=-1)
    lengths = lengths[np.isfinite(lengths)]
    return float(np.median(lengths)) if len(lengths) else float("nan")
