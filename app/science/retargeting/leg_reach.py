"""Legs that reach for another place of the ankle: two bones, solved in closed form.

With a and b the lengths of thigh and shin and d the distance from hip to ankle, the law of cosines
gives the hip's angle between thigh and the way to the ankle,

    cos(alpha) = (a^2 + d^2 - b^2) / (2 a d).

The knee stays on the side it bends to: its plane turns with the way to the ankle, by the smallest
turn. A straight leg has no plane, so a little of the body's forward direction decides there. All
arrays are N frames at once; lengths are metres, directions and turns in the world.
"""

from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray, multiply, rotate, swing_between

# Straighter than this a leg may not be made: at full stretch a knee snaps.
STRETCH = 0.995
_FORWARD_SHARE = 1e-3


@dataclass(frozen=True, eq=False)
class Reach:
    """A solved leg.

    Attributes:
        thigh_turns, shin_turns: (N, 4) world turns to put before world_from_thigh and _shin.
        short_m: (N,) by how much the ankle stays away from its target; 0 where it is reached.
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
    """Turn legs (N, 3) so that their ankles come to the targets (N, 3), or as near as they can.

    Args:
        hip_m, knee_m, ankle_m: where the joints are.
        target_m: where the ankle shall be.
        right: (N, 3) from the left to the right hip socket; knees bend forward of it.
    """
    thigh, shin, way = knee_m - hip_m, ankle_m - knee_m, ankle_m - hip_m
    a, b, wanted = _length(thigh), _length(shin), target_m - hip_m
    distance = _length(wanted)
    reach = np.clip(distance, np.abs(a - b) + 1e-9, longest_m(a, b, _length(way)))
    onto = wanted / np.maximum(distance, 1e-12)
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
    """How far legs may stretch: not to the full, but as far as they already do."""
    return np.maximum(STRETCH * (a + b), now)


def _turn(swung: FloatArray, before: FloatArray, after: FloatArray) -> FloatArray:
    """First with the whole leg, then by the smallest turn to the bone's new direction."""
    return multiply(swing_between(rotate(swung, before), after), swung)


def _side(thigh: FloatArray, onto: FloatArray, right: FloatArray) -> FloatArray:
    """Unit direction in which the knee leaves the straight line from hip to ankle."""
    forward = np.cross(right, onto)
    pole = thigh + _FORWARD_SHARE * forward / np.maximum(_length(forward), 1e-12)
    across = pole - np.sum(pole * onto, axis=-1, keepdims=True) * onto
    return np.asarray(across / np.maximum(_length(across), 1e-12))


def _length(vectors: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.norm(vectors, axis=-1, keepdims=True))
