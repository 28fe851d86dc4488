"""Inverse kinematics of legs: reach another ankle position with two bones, in closed form.

With a and b the lengths of thigh and shin and d the distance from hip to ankle, the law of cosines
gives the angle at the hip between the thigh and the line to the ankle,

    cos(alpha) = (a^2 + d^2 - b^2) / (2 a d).

The knee stays on the side to which it bends: its plane turns with the line to the ankle, by the
smallest rotation. A straight leg defines no plane, so a small component of the body's forward
direction decides there. All arrays are N frames; lengths are in metres, directions and rotations in
the world.
"""

from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray, multiply, rotate, swing_between

# A leg is not stretched further than this: at full stretch a knee snaps.
STRETCH = 0.995
_FORWARD_SHARE = 1e-3


@dataclass(frozen=True, eq=False)
class Reach:
    """A leg solved for an ankle target.

    Attributes:
        thigh_turns, shin_turns: (N, 4) world rotations to apply to world_from_thigh and _shin.
        short_m: (N,) remaining distance from the ankle to its target; 0 where it is reached.
    """

    thigh_turns: FloatArray
    shin_turns: FloatArray
    short_m: FloatArray


def reach_for(
    hip_m: FloatArray,
    knee_m: FloatArray,
    ankle_m: FloatArray,
    target_m: FloatArray,
    right: FloatArray,
) -> Reach:
    """Turn legs (N, 3) so that their ankles reach the targets (N, 3), or come as close as possible.

    Args:
        hip_m, knee_m, ankle_m: positions of the joints.
        target_m: positions that the ankles should reach.
        right: (N, 3) vector from the left to the right hip joint; knees bend forward of it.
    """
    thigh, shin, way = knee_m - hip_m, ankle_m - knee_m, ankle_m - hip_m
    a, b, to_target = _length(thigh), _length(shin), target_m - hip_m
    distance = _length(to_target)
    reach = np.clip(distance, np.abs(a - b) + 1e-9, longest_m(a, b, _length(way)))
    onto = to_target / np.maximum(distance, 1e-12)
    swung = swing_between(way, onto)
    side = _side(rotate(swung, thigh) / a, onto, right)
    cosine = np.clip((a**2 + reach**2 - b**2) / (2.0 * a * reach), -1.0, 1.0)
    new_thigh = a * (cosine * onto + np.sqrt(1.0 - cosine**2) * side)
    return Reach(
        _turn(swung, thigh, new_thigh),
        _turn(swung, shin, reach * onto - new_thigh),
        (distance - reach)[..., 0].clip(min=0.0),
    )


def longest_m(a: FloatArray, b: FloatArray, now: FloatArray) -> FloatArray:
    """Return the length to which legs may stretch: almost full, or the present one if longer."""
    return np.maximum(STRETCH * (a + b), now)


def _turn(swung: FloatArray, before: FloatArray, after: FloatArray) -> FloatArray:
    """Return the leg's swing followed by the smallest rotation to the bone's new direction."""
    return multiply(swing_between(rotate(swung, before), after), swung)


def _side(thigh: FloatArray, onto: FloatArray, right: FloatArray) -> FloatArray:
    """Return the unit direction in which the knee deviates from the line from hip to ankle."""
    forward = np.cross(right, onto)
    pole = thigh + _FORWARD_SHARE * forward / np.maximum(_length(forward), 1e-12)
    across = pole - np.sum(pole * onto, axis=-1, keepdims=True) * onto
    return np.asarray(across / np.maximum(_length(across), 1e-12))


def _length(vectors: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.norm(vectors, axis=-1, keepdims=True))
