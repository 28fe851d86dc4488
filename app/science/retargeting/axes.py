"""Which way is up, and where the left arm of a T-pose points: the frame a pose is described in.

A T-pose has its torso along `up`, its legs along `-up`, its left arm along `left` and its right arm
along `-left`. Quaternion algebra is the same in left-handed frames; only the way a person faces
depends on the hand.
"""

from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray, Vector, v_cross, v_dot, v_scale

_TOLERANCE = 1e-9


class AxesError(ValueError):
    """The two directions are no unit vectors across each other."""


@dataclass(frozen=True)
class Axes:
    """Directions of a T-pose in the world.

    Attributes:
        up, left: unit vectors across each other.
        left_handed: whether the frame is left-handed, as Unreal's and Unity's are.
    """

    up: Vector
    left: Vector
    left_handed: bool = False

    def __post_init__(self) -> None:
        """Raises AxesError where the directions are no unit vectors across each other."""
        lengths = (v_dot(self.up, self.up), v_dot(self.left, self.left))
        if max(abs(length - 1.0) for length in lengths) > _TOLERANCE or (
            abs(v_dot(self.up, self.left)) > _TOLERANCE
        ):
            raise AxesError(
                f"Up {self.up} and left {self.left} span no frame: give unit vectors at a right"
                " angle."
            )

    @property
    def forward(self) -> Vector:
        """The direction a body with these axes faces."""
        right_handed = v_cross(self.left, self.up)
        return v_scale(right_handed, -1.0) if self.left_handed else right_handed

    def up_array(self) -> FloatArray:
        """`up` as (3,)."""
        return np.array(self.up)

    def left_array(self) -> FloatArray:
        """`left` as (3,)."""
        return np.array(self.left)


CANONICAL = Axes(up=(0.0, 1.0, 0.0), left=(-1.0, 0.0, 0.0))
"""The product's own frame: y up, left along -x, facing -z, right-handed."""

UNREAL = Axes(up=(0.0, 0.0, 1.0), left=(1.0, 0.0, 0.0), left_handed=True)
"""A mesh in Unreal Engine: z up, left arm along +x, facing +y, left-handed."""
