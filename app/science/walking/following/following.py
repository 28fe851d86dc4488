"""The agent: follows a planned path with limited speed, acceleration and curvature.

Steering after Reynolds (1999), "Steering behaviors for autonomous characters" (path following and
arrival). At each step of `dt_s`, with parameters v_max, a_max and omega:

    aim      the point of the path `lookahead_m` ahead of the agent's nearest one
    turn     towards it, by at most omega * v * dt: angular velocity is tied to velocity, which
             makes omega the largest curvature (1/m)
    speed    towards min(v_max, sqrt(2 a_max d)), d the remaining distance, by at most a_max * dt:
             it can always stop at the goal; never slower than `floor_m_s`. Within a step the
             acceleration is constant, and d is computed so that braking ends at the goal
    arrival  within `radius_m` of the goal, its time interpolated within the step; then it stays

It starts in the direction of the path. The values that the paper does not state (step, look-ahead,
radius, floor) are fixed in `FollowingRules` and printed with every result. An agent that cannot
turn enough circles around the goal, and has not arrived when its time is over.
"""

from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.following.course import Pace, Way, way_of
from app.science.walking.records import (
    PAPER_PARAMETERS,
    Course,
    SteeringParameter,
    Trajectories,
    WalkingError,
)


@dataclass(frozen=True)
class FollowingRules:
    """Settings that are the same for all agents."""

    dt_s: float = 1.0 / 60.0
    lookahead_m: float = 0.4
    radius_m: float = 0.05
    floor_m_s: float = 0.02

    def __post_init__(self) -> None:
        """Raise WalkingError if a value is not positive."""
        for name in ("dt_s", "lookahead_m", "radius_m", "floor_m_s"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise WalkingError(f"{name} is {getattr(self, name)}; it must be positive.")


@dataclass(frozen=True)
class SteeringFollower:
    """Follows paths with parameters (v_max, a_max, omega); a `PathFollower`.

    Attributes:
        rules: the rules, which are the same for all agents.
    """

    rules: FollowingRules = FollowingRules()

    @property
    def parameters(self) -> tuple[SteeringParameter, ...]:
        """The three parameters: velocity, acceleration, angular."""
        return PAPER_PARAMETERS

    @property
    def dt_s(self) -> float:
        """The time step of the simulation, s."""
        return self.rules.dt_s

    def follow(self, course: Course, vectors: FloatArray) -> Trajectories:
        """Let one agent for each vector (K, 3) follow the course.

        Raises:
            WalkingError: the vectors have another shape or are not positive, or the course has no
                samples.
        """
        vectors = np.ascontiguousarray(vectors, dtype=np.float64)
        if vectors.ndim != 2 or vectors.shape[1] != 3:
            raise WalkingError(f"Vectors (K, 3) of v, a, omega are needed, got {vectors.shape}.")
        if not (np.isfinite(vectors).all() and (vectors > 0.0).all()):
            raise WalkingError("Velocity, acceleration and angular must be positive numbers.")
        if course.samples < 1 or not 0.0 < course.time_limit_s < np.inf:
            raise WalkingError(
                f"A course of {course.samples} samples and {course.time_limit_s} s is invalid."
            )
        if len(course.path.points_m) > 2:
            return self._followed(course, vectors)
        # On one straight leg omega has no effect: agents with equal v and a are simulated once.
        _, first, like = np.unique(vectors[:, :2], axis=0, return_index=True, return_inverse=True)
        few = self._followed(course, vectors[first])
        return Trajectories(few.xy_m[like], few.arrival_s[like])

    def _followed(self, course: Course, vectors: FloatArray) -> Trajectories:
        places = np.empty((len(vectors), course.samples, 2))
        arrival = np.full(len(vectors), np.nan)
        self._move(way_of(course.path), vectors, self._pace(course), places, arrival)
        return Trajectories(places, arrival)

    def _pace(self, course: Course) -> Pace:
        rules = self.rules
        steps = int(np.ceil(course.time_limit_s / rules.dt_s - 1e-9))
        begin = max(rules.floor_m_s, course.initial_speed_m_s)
        fixed = (rules.dt_s, rules.lookahead_m, rules.radius_m, rules.floor_m_s)
        return Pace(*fixed, begin, course.brakes, steps)

    def _move(
        self, way: Way, vectors: FloatArray, pace: Pace, places: FloatArray, arrival: FloatArray
    ) -> None:
        from app.science.walking.following.following_kernels import move_all

        move_all(way, vectors, pace, places, arrival)
