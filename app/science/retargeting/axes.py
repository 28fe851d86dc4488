"""Axes of the frame in which a pose is described, and the shortest rotation between directions.

The axes say which way is up, and where the left arm of a T-pose points: the T-pose has its torso
along `up`, its legs along `-up`, its left arm along `left` and its right arm along `-left`.
Quaternion algebra is the same in left-handed frames; only the way a person faces depends on the
handedness.

The shortest rotation (`swing`) is exact to rounding at every angle. The half-vector form q ~ (1 +
v.k, v x k) loses digits as v and k become opposite: 1 + v.k is then a difference of almost equal
numbers. Here the sine and cosine of half the angle are the lengths

    cos(a/2) = |v + k| / 2,   sin(a/2) = |v - k| / 2,

which are exact to rounding, and the axis is v x k, made perpendicular to v. So v is mapped to k
within a few units of rounding even if they are nearly opposite, where arccos(v.k) is off by 5e-4 in
single precision. For v and k exactly opposite any axis perpendicular to v is possible; the caller
may give one.
"""

from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray, Vector, v_cross, v_dot, v_scale

_TOLERANCE = 1e-9


class AxesError(ValueError):
    """The two directions are not perpendicular unit vectors."""


@dataclass(frozen=True)
class Axes:
    """Directions of a T-pose in the world.

    Attributes:
        up, left: perpendicular unit vectors.
        left_handed: whether the frame is left-handed, as Unreal's and Unity's are.
    """

    up: Vector
    left: Vector
    left_handed: bool = False

    def __post_init__(self) -> None:
        """Raise AxesError if the directions are not perpendicular unit vectors."""
        lengths = (v_dot(self.up, self.up), v_dot(self.left, self.left))
        if max(abs(length - 1.0) for length in lengths) > _TOLERANCE or (
            abs(v_dot(self.up, self.left)) > _TOLERANCE
        ):
            raise AxesError(
                f"Up {self.up} and left {self.left} do not define a frame: give perpendicular unit"
                " vectors."
            )

    @property
    def forward(self) -> Vector:
        """The direction in which a body with these axes faces."""
        right_handed = v_cross(self.left, self.up)
        return v_scale(right_handed, -1.0) if self.left_handed else right_handed

    def up_array(self) -> FloatArray:
        """Return `up` as an array (3,)."""
        return np.array(self.up)

    def left_array(self) -> FloatArray:
        """Return `left` as an array (3,)."""
        return np.array(self.left)


CANONICAL = Axes(up=(0.0, 1.0, 0.0), left=(-1.0, 0.0, 0.0))
"""The product's own frame: y up, left along -x, facing -z, right-handed."""

UNREAL = Axes(up=(0.0, 0.0, 1.0), left=(1.0, 0.0, 0.0), left_handed=True)
"""A mesh in Unreal Engine: z up, left arm along +x, facing +y, left-handed."""


def swing(start: FloatArray, end: FloatArray, across: FloatArray | None = None) -> FloatArray:
    """Return the rotation (4,) that brings the direction `start` onto `end`, both (3,).

    It is computed in the precision of the arguments (float64 or float32). Directions may have any
    length above zero. `across` is the rotation axis for opposite directions, perpendicular to
    `start`.
    """
    v, k = unit(start), unit(end)
    cosine = np.linalg.norm(v + k)
    sine = np.linalg.norm(v - k)
    return unit(np.concatenate(([cosine], sine * _axis(v, k, across))).astype(v.dtype))


def unit(vector: FloatArray) -> FloatArray:
    """Return the vector scaled to length one, in its own precision."""
    scaled: FloatArray = vector / np.linalg.norm(vector)
    return scaled


def _axis(v: FloatArray, k: FloatArray, fallback: FloatArray | None) -> FloatArray:
    across = np.cross(v, k)
    length = np.linalg.norm(across)
    square = across - v * np.dot(v, across)
    # If half of the product or more is along v, it consists of rounding errors only.
    if float(np.linalg.norm(square)) > 0.5 * float(length) > 0.0:
        return unit(square)
    if fallback is not None:
        return unit(fallback)
    least = np.zeros_like(v)
    least[np.argmin(np.abs(v))] = 1.0
    return unit(np.cross(v, least))
