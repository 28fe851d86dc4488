"""A course prepared for the agents: the path in legs, the simulation's numbers, its time limit."""

from typing import NamedTuple

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records import Course, PlannedPath, Walk

TIMES_REFERENCE = 2.0
EXTRA_S = 1.0


class Way(NamedTuple):
    """A path prepared for the agents: P points, P - 1 legs.

    Attributes:
        points: (P, 2) points of the path.
        units: (P - 1, 2) direction of each leg.
        lengths: (P - 1,) length of each leg.
        before: (P,) distance along the path up to each point.
    """

    points: FloatArray
    units: FloatArray
    lengths: FloatArray
    before: FloatArray


class Pace(NamedTuple):
    """The numbers of one simulation: rules, initial speed, braking, largest number of steps."""

    dt: float
    lookahead: float
    radius: float
    floor: float
    begin: float
    brakes: bool
    steps: int


def way_of(path: PlannedPath) -> Way:
    """Divide a path into legs for the agents."""
    legs = np.diff(path.points_m, axis=0)
    lengths = np.linalg.norm(legs, axis=1)
    points = np.ascontiguousarray(path.points_m, dtype=np.float64)
    return Way(points, legs / lengths[:, None], lengths, path.arc_m)


def course_of(walk: Walk, path: PlannedPath, dt_s: float) -> Course:
    """Return the course on which a walk is re-simulated.

    An agent has not arrived if it takes longer than twice the walk's time plus a second: its
    suitability in time is then below exp(-10). If the recording cuts off the start or the end of
    the walk, the agent starts, or ends, at speed.
    """
    samples = int(np.floor(walk.duration_s / dt_s + 1e-9)) + 1
    begin_m_s = 0.0 if walk.begins_still else float(walk.speeds_m_s[0])
    limit_s = TIMES_REFERENCE * walk.duration_s + EXTRA_S
    return Course(path, samples, limit_s, begin_m_s, walk.ends_still)
