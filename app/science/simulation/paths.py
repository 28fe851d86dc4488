"""Smooth paths through way-points, and how quickly a body can move along them.

One movement from a to b in the time d follows the minimum-jerk profile (Flash and Hogan 1985,
J. Neuroscience 5:1688-1703)

    x(t) = a + (b - a) (10 s^3 - 15 s^4 + 6 s^5),   s = t / d.

Several movements overlap a little and add up, which rounds the corners at the way-points
(superposition of submovements: Flash and Henis 1991, J. Cognitive Neuroscience 3:220-230).

People's profiles are often skewed: they are fastest early and home in, or late (Nagasaki 1989,
Experimental Brain Research 74:319-326). A skewed movement follows the same profile with its time
warped, s = 1 - (1 - t / d)^skew: above 1 it is fastest early, below 1 late, and 1 changes nothing.
The form of this warp is our own.

Joints turn no faster than muscles can turn them (`limit_turn_rate`). Inverse kinematics has
singular poses, in which a small change of the goal turns a joint by any angle within one frame: an
elbow or a knee that becomes straight, fingers along the arm's own axis. There a joint turns as
quickly as a person's can, and reaches its rotation some frames later.
"""

from dataclasses import dataclass
from itertools import pairwise
from math import acos, cos, pi, radians, sqrt

import numpy as np

from app.science.rotations import FloatArray, Quaternion, Vector, q_slerp, v_length, v_subtract

_OVERLAP = 0.25


def minimum_jerk(progress: float) -> float:
    """Return the share of the way covered after a share of the time, both 0 to 1 (clamped)."""
    if progress <= 0.0:
        return 0.0
    if progress >= 1.0:
        return 1.0
    return progress**3 * (10.0 + progress * (6.0 * progress - 15.0))


def skewed_jerk(progress: float, skew: float) -> float:
    """Return the share of the way covered by a skewed movement after a share of its time.

    Any progress is valid and clamped to 0 to 1; `skew` is above 1/3, else the speed at the end
    would not be zero.
    """
    if skew == 1.0 or not 0.0 < progress < 1.0:
        return minimum_jerk(progress)
    return minimum_jerk(1.0 - (1.0 - progress) ** skew)


@dataclass(frozen=True)
class SmoothPath:
    """A path in time: its start point and its movements (start time, duration, displacement).

    All movements have the same `skew`, 1 for minimum jerk.
    """

    start_m: Vector
    moves: tuple[tuple[float, float, Vector], ...]
    skew: float = 1.0

    @property
    def end_s(self) -> float:
        """The time at which the last movement ends."""
        return max(start + duration for start, duration, _ in self.moves)

    def waiting_to_enter(self, leg: int, until_s: float) -> "SmoothPath":
        """Return the path with movement `leg` and all later ones delayed until `until_s`."""
        delay_s = max(until_s - self.moves[leg][0], 0.0)
        later = tuple((begins + delay_s, lasts, way) for begins, lasts, way in self.moves[leg:])
        return SmoothPath(self.start_m, self.moves[:leg] + later, self.skew)

    def at(self, time_s: float) -> Vector:
        """Return the point of the path at a time; constant before the start and after the end."""
        x, y, z = self.start_m
        for start, duration, (dx, dy, dz) in self.moves:
            share = skewed_jerk((time_s - start) / duration, self.skew)
            x, y, z = x + share * dx, y + share * dy, z + share * dz
        return (x, y, z)


def path_length(points: list[Vector]) -> float:
    """Return the total length of the straight lines through the points."""
    return sum(v_length(v_subtract(b, a)) for a, b in pairwise(points))


def path_through(
    points: list[Vector], start_s: float, duration_s: float, skew: float = 1.0
) -> SmoothPath:
    """Return a path through two or more points that takes `duration_s` in all.

    A longer leg gets more time, by the square root of its length, so that all have equal
    acceleration.
    """
    legs = [v_subtract(b, a) for a, b in pairwise(points)]
    shares = [sqrt(v_length(leg)) + 1e-3 for leg in legs]
    # Every leg but the first starts before the previous one ends, which shortens the total time.
    stretch = duration_s / (sum(shares) - _OVERLAP * sum(shares[:-1]))
    moves, begins = [], start_s
    for leg, share in zip(legs, shares, strict=True):
        lasts = share * stretch
        moves.append((begins, lasts, leg))
        begins += lasts * (1.0 - _OVERLAP)
    return SmoothPath(points[0], tuple(moves), skew)


MOST_TURN_RAD_PER_S = radians(1500.0)
"""Fastest turn of a joint: elbows and wrists of people who hurry reach 1300 deg/s."""
MOST_SINK_M_PER_S = 2.5
"""Fastest sinking of the hips: after a third of a second of free fall they reach 3 m/s."""


def limit_turn_rate(previous: FloatArray, rotations: FloatArray, step_s: float) -> FloatArray:
    """Limit how far each local rotation (n, 4) turns from its previous one within a step.

    All quaternions have length 1. Each turns the shorter way.
    """
    from app.science.simulation.posture_kernels import least_cosine

    half_turn = 0.5 * MOST_TURN_RAD_PER_S * step_s
    near = cos(min(half_turn, 0.5 * pi))
    if least_cosine(previous, rotations) >= near:
        return rotations
    limited = [
        b if abs(cosine := _dot(a, b)) >= near else q_slerp(a, b, half_turn / acos(abs(cosine)))
        for a, b in zip(previous.tolist(), rotations.tolist(), strict=True)
    ]
    return np.array(limited)


def _dot(a: Quaternion, b: Quaternion) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
