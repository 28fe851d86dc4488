"""Unit quaternions (w, x, y, z) as the one language of orientation.

`arrays` works on whole recordings, shape (..., 4); `scalars` works on one quaternion at a time as a
plain tuple, which is several times faster where a single frame has to be made or followed.
"""

from app.science.rotations.arrays import (
    FloatArray,
    RotationError,
    conjugate,
    from_euler,
    from_rotation_vector,
    geodesic_angle,
    identity,
    is_unit,
    multiply,
    normalise,
    rotate,
    shortest,
    slerp,
    swing_between,
    to_euler,
    to_rotation_vector,
)

__all__ = [
    "FloatArray",
    "RotationError",
    "conjugate",
    "from_euler",
    "from_rotation_vector",
    "geodesic_angle",
    "identity",
    "is_unit",
    "multiply",
    "normalise",
    "rotate",
    "shortest",
    "slerp",
    "swing_between",
    "to_euler",
    "to_rotation_vector",
]
