"""Persons who cross: along a recorded path, or walking by the walking model."""

import itertools
from dataclasses import dataclass
from math import atan2, hypot, pi, remainder

import numpy as np

from app.science.cosimulation.partners import InProcess, Request
from app.science.cosimulation.road import Road, arrival_s
from app.science.cosimulation.states import CosimulationError, State
from app.science.rotations import FloatArray
from app.science.walking.following import FollowingRules, SteeringFollower
from app.science.walking.records import Course, PlannedPath, Point

BODY_M = 0.5
"""Diameter of a person on the floor."""
_STANDING_M_S = 0.05


class _Person(InProcess):
    """Keeps a person's last state, to say speed and heading of a path of places."""

    def __init__(self, name: str, step_s: float, start: Point, heading_rad: float) -> None:
        super().__init__(name, step_s)
        outline = (BODY_M, BODY_M)
        self._last = State(name, "person", 0.0, *start, heading_rad, 0.0, 0.0, *outline)

    def start(self) -> tuple[State, ...]:
        """Return the person, standing."""
        return (self._last,)

    def _moved(self, to: Point, time_s: float) -> tuple[State, ...]:
        last, dt_s = self._last, time_s - self._last.time_s
        dx_m, dy_m = to[0] - last.x_m, to[1] - last.y_m
        speed = hypot(dx_m, dy_m) / dt_s
        # Somebody who stands keeps facing the same way.
        heading = atan2(dy_m, dx_m) if speed > _STANDING_M_S else last.heading_rad
        turned = remainder(heading - last.heading_rad, 2.0 * pi)
        # From standing to walking the heading jumps, which is no turning that goes on.
        turn = turned / dt_s if last.speed_m_s > _STANDING_M_S else 0.0
        outline = (BODY_M, BODY_M)
        self._last = State(
            self.name, "person", time_s, float(to[0]), float(to[1]), heading, speed, turn, *outline
        )
        return (self._last,)


class RecordedPath(_Person):
    """A person whose path was recorded; before and after it they stand at its ends.

    Args:
        name: of the partner and its actor.
        step_s: its step.
        times_s: (N,) increasing scene times.
        xy_m: (N, 2) places on the floor.
    """

    def __init__(self, name: str, step_s: float, times_s: FloatArray, xy_m: FloatArray) -> None:
        if times_s.ndim != 1 or xy_m.shape != (len(times_s), 2) or not len(times_s):
            raise CosimulationError(f"The path of {name!r} needs times (N,) and places (N, 2).")
        if not (np.diff(times_s) > 0.0).all():
            raise CosimulationError(f"The times of {name!r}'s path must increase.")
        self._times_s, self._xy_m = times_s, xy_m
        x_m, y_m = self._at(0.0)
        super().__init__(name, step_s, (x_m, y_m), pi / 2.0 if y_m < 0.0 else -pi / 2.0)

    def advance(self, request: Request) -> tuple[State, ...]:
        """Return where the recording says the person is."""
        return self._moved(self._at(request.to_s), request.to_s)

    def _at(self, time_s: float) -> Point:
        x_m, y_m = (float(np.interp(time_s, self._times_s, self._xy_m[:, a])) for a in (0, 1))
        return x_m, y_m


@dataclass(frozen=True)
class WalkerPlan:
    """What a walker of the walking model is going to do.

    Attributes:
        path: from where they stand at first to where they go, crossing one kerb and then the other.
        vector: (3,) steering parameters: velocity, acceleration, angular.
        leaves_s: when they begin to walk.
        waits_m: how far from the kerb they stop to look.
        looks_s: for how long they look at least.
        accepts_s: shortest time to the next car's arrival at which they go.
    """

    path: PlannedPath
    vector: FloatArray
    leaves_s: float = 0.0
    waits_m: float = 0.4
    looks_s: float = 1.0
    accepts_s: float = 4.0


class Walker(_Person):
    """Walks to the kerb, waits until no car would arrive too soon, and crosses.

    Both ways are those of the walking model's agent (`SteeringFollower`). At the kerb the walker
    knows places and speeds of all cars; one that stands, and so gives way, never arrives. Once on
    the carriageway they keep going.

    Raises:
        CosimulationError: the path does not cross the first kerb.
    """

    def __init__(self, name: str, step_s: float, plan: WalkerPlan, road: Road) -> None:
        self._plan = plan
        waits = _waiting_point(name, plan, road)
        points = plan.path.points_m
        side = waits[1] > 0.0
        beyond = [i for i, y in enumerate(points[:, 1]) if (y < waits[1] if side else y > waits[1])]
        before = [tuple(point) for point in points[: beyond[0]]]
        after = [tuple(point) for point in points[beyond[0] :]]
        self._x_m = float(np.interp(0.0, *_by_y(np.array([waits, *after]))))
        self._to_kerb = _agent([*before, waits], plan.vector, step_s)
        self._across = _agent([waits, *after], plan.vector, step_s)
        self._at_kerb_s: float | None = None
        self._goes_s: float | None = None
        heading = -pi / 2.0 if side else pi / 2.0
        super().__init__(name, step_s, (float(points[0, 0]), float(points[0, 1])), heading)

    def advance(self, request: Request) -> tuple[State, ...]:
        """Walk one step, or decide whether to go."""
        plan, now_s = self._plan, request.from_s
        if self._goes_s is None and self._at_kerb_s is not None:
            looked = now_s - self._at_kerb_s >= plan.looks_s - 1e-9
            if looked and self._gap_s(request) >= plan.accepts_s:
                self._goes_s = now_s
        if self._goes_s is not None:
            return self._moved(self._place(self._across, self._goes_s, request.to_s), request.to_s)
        if now_s < plan.leaves_s - 1e-9:
            return self._moved((self._last.x_m, self._last.y_m), request.to_s)
        place = self._place(self._to_kerb, plan.leaves_s, request.to_s)
        arrived = request.to_s - plan.leaves_s >= (len(self._to_kerb) - 1) * self.step_s - 1e-9
        if arrived and self._at_kerb_s is None:
            self._at_kerb_s = request.to_s
        return self._moved(place, request.to_s)

    def _gap_s(self, request: Request) -> float:
        arrivals = [
            arrival_s(other, self._x_m, BODY_M / 2.0)
            for other in request.others
            if other.kind == "car"
        ]
        return min(arrivals, default=float("inf"))

    def _place(self, walked: FloatArray, began_s: float, time_s: float) -> Point:
        index = min(len(walked) - 1, max(0, round((time_s - began_s) / self.step_s)))
        return float(walked[index, 0]), float(walked[index, 1])


def _waiting_point(name: str, plan: WalkerPlan, road: Road) -> Point:
    """Return where the path first comes within `waits_m` of the kerb."""
    points = plan.path.points_m
    side = 1.0 if points[0, 1] > 0.0 else -1.0
    waits_m = road.lane_width_m + plan.waits_m
    if abs(points[0, 1]) <= waits_m or (points[:, 1] * side > -road.lane_width_m).all():
        raise CosimulationError(
            f"The path of {name!r} must begin more than {waits_m:g} m from the road's middle line"
            f" and end more than {road.lane_width_m:g} m behind it."
        )
    for start, end in itertools.pairwise(points):
        if end[1] * side < waits_m:
            share = (start[1] * side - waits_m) / ((start[1] - end[1]) * side)
            return float(start[0] + share * (end[0] - start[0])), side * waits_m
    raise AssertionError("the path ends on the other side")


def _by_y(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    order = np.argsort(points[:, 1], kind="stable")
    return points[order, 1], points[order, 0]


def _agent(points: list[Point], vector: FloatArray, step_s: float) -> FloatArray:
    """Return the places (N, 2) of the walking model's agent at each step, until it arrives."""
    path = PlannedPath(np.array(points, dtype=np.float64))
    limit_s = 10.0 + 3.0 * path.length_m / float(vector[0])
    samples = int(limit_s / step_s) + 1
    follower = SteeringFollower(FollowingRules(dt_s=step_s))
    course = Course(path, samples, limit_s, 0.0, True)
    walked = follower.follow(course, vector[None])
    if not walked.arrived[0]:
        raise CosimulationError(
            f"A walker with velocity, acceleration and angular of {vector.tolist()} does not arrive"
            " on this path: give a larger angular or a straighter path."
        )
    return walked.xy_m[0, : int(np.ceil(walked.arrival_s[0] / step_s)) + 1]
