"""Smooth paths through way-points, and how quickly a body can move along them.

One movement from a to b in the time d follows the minimum-jerk profile (Flash and Hogan 1985,
J. Neuroscience 5:1688-1703)

    x(t) = a + (b - a) (10 s^3 - 15 s^4 + 6 s^5),   s = t / d.

Several movements overlap a little and add up, which rounds the corners at the way-points
(superposition of submovements: Flash and Henis 1991, J. Cognitive Neuroscience 3:220-230).

Joints turn no quicker than muscles can (`no_quicker`), whatever is asked of the limbs. Inverse
kinematics has places where a small change of what is asked turns a joint by any angle at once: an
elbow or a knee that becomes straight, fingers along the arm's own axis. Muscles do not: a joint
turns there as quickly as a person's can, and is where it should be some frames later.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import acos, cos, pi, radians, sqrt

from app.science.rotations import Quaternion, Vector, q_slerp, v_length, v_subtract

_OVERLAP = 0.25


def minimum_jerk(progress: float) -> float:
    """Return the travelled share, 0 to 1, at a share of the time; held outside 0 to 1."""
    if progress <= 0.0:
        return 0.0
    if progress >= 1.0:
        return 1.0
    return progress**3 * (10.0 + progress * (6.0 * progress - 15.0))


@dataclass(frozen=True)
class SmoothPath:
    """A path in time: where it starts and the movements (start time, duration, displacement)."""

    start_m: Vector
    moves: tuple[tuple[float, float, Vector], ...]

    @property
    def end_s(self) -> float:
        """When the last movement ends."""
        return max(start + duration for start, duration, _ in self.moves)

    def waiting_to_enter(self, leg: int, until_s: float) -> "SmoothPath":
        """Return the path with everything from this leg on put off so that it begins then."""
        delay_s = max(until_s - self.moves[leg][0], 0.0)
        later = tuple((begins + delay_s, lasts, way) for begins, lasts, way in self.moves[leg:])
        return SmoothPath(self.start_m, self.moves[:leg] + later)

    def at(self, time_s: float) -> Vector:
        """Return the point at a time; held before the start and after the end."""
        x, y, z = self.start_m
        for start, duration, (dx, dy, dz) in self.moves:
            share = minimum_jerk((time_s - start) / duration)
            x, y, z = x + share * dx, y + share * dy, z + share * dz
        return (x, y, z)


def path_length(points: list[Vector]) -> float:
    """Return the length of straight lines through the points."""
    return sum(v_length(v_subtract(b, a)) for a, b in pairwise(points))


def path_through(points: list[Vector], start_s: float, duration_s: float) -> SmoothPath:
    """Make a path through two or more points that takes `duration_s` in all.

    A longer leg gets more time, by the square root of its length: legs of equal acceleration.
    """
    legs = [v_subtract(b, a) for a, b in pairwise(points)]
    shares = [sqrt(v_length(leg)) + 1e-3 for leg in legs]
    # Every leg but the last hands over before its end, so the legs together take less time.
    stretch = duration_s / (sum(shares) - _OVERLAP * sum(shares[:-1]))
    moves, begins = [], start_s
    for leg, share in zip(legs, shares, strict=True):
        lasts = share * stretch
        moves.append((begins, lasts, leg))
        begins += lasts * (1.0 - _OVERLAP)
    return SmoothPath(points[0], tuple(moves))


MOST_TURN_RAD_PER_S = radians(1500.0)
"""Elbows and wrists of people who hurry reach 1300 deg/s."""
MOST_SINK_M_PER_S = 2.5
"""Hips that sink freely for a third of a second fall 3 m/s."""


def no_quicker(
    before: Sequence[Quaternion], wanted: Sequence[Quaternion], step_s: float
) -> list[Quaternion]:
    """Return the wanted local rotations, each only as far from the one before as it can have come.

    All quaternions have length 1. The shorter way is taken.
    """
    half_turn = 0.5 * MOST_TURN_RAD_PER_S * step_s
    near = cos(min(half_turn, 0.5 * pi))
    return [
        b if abs(cosine := _dot(a, b)) >= near else q_slerp(a, b, half_turn / acos(abs(cosine)))
        for a, b in zip(before, wanted, strict=True)
    ]


def _dot(a: Quaternion, b: Quaternion) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
