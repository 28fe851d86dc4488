"""What can be exchanged: the planner, the follower of its path, and the measure of deviation.

    Planner       scene, start, goal      -> PlannedPath
    PathFollower  path, K vectors         -> Trajectories   (the steering parameters enter here)
    Metric        reference, Trajectories -> K deviations, smaller is better

A follower names its steering parameters; a grid is made over those. All K agents are simulated at
once at steps of `dt_s`, from time 0. The reference is sampled at the same steps.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray
from app.science.walking.records.model import PlannedPath, Walk
from app.science.walking.records.parameters import SteeringParameter

Point = tuple[float, float]
BoolArray = npt.NDArray[np.bool_]


class Planner(Protocol):
    """Lays paths in one scene; deterministic."""

    def plan(self, start_m: Point, goal_m: Point) -> PlannedPath:
        """Return the path; raises SceneError where there is none."""
        ...


@dataclass(frozen=True)
class Course:
    """How an agent is to follow a path, besides its steering parameters.

    Attributes:
        path: what to follow.
        samples: positions to report, at 0, dt, 2 dt, ...: as many as the reference has.
        time_limit_s: an agent that has not arrived by then has not arrived.
        initial_speed_m_s: 0 for who stands, else the speed at which the recording begins.
        brakes: whether the agent stops at the goal, or passes it at speed.
    """

    path: PlannedPath
    samples: int
    time_limit_s: float
    initial_speed_m_s: float = 0.0
    brakes: bool = True


@dataclass(frozen=True, eq=False)
class Trajectories:
    """What K agents did on one course.

    Attributes:
        xy_m: (K, samples, 2) places; an agent that has arrived stays where it did.
        arrival_s: (K,) travel times, NaN for agents that did not arrive in time.
    """

    xy_m: FloatArray
    arrival_s: FloatArray

    @property
    def arrived(self) -> BoolArray:
        """(K,) whether each agent came to the goal."""
        return np.isfinite(self.arrival_s)


class PathFollower(Protocol):
    """Moves agents along a path; deterministic."""

    @property
    def parameters(self) -> tuple[SteeringParameter, ...]:
        """The n steering parameters, in the order of a vector's columns."""
        ...

    @property
    def dt_s(self) -> float:
        """The time between samples."""
        ...

    def follow(self, course: Course, vectors: FloatArray) -> Trajectories:
        """Let one agent for each of the vectors (K, n) follow the course."""
        ...


@dataclass(frozen=True, eq=False)
class Reference:
    """A walk sampled at the follower's steps.

    Attributes:
        xy_m: (N, 2) at 0, dt, 2 dt, ... up to the end of the walk.
        dt_s: the step.
        length_m: distance walked.
        duration_s: exact travel time.
    """

    xy_m: FloatArray
    dt_s: float
    length_m: float
    duration_s: float


class Metric(Protocol):
    """How far agents are from a reference."""

    @property
    def name(self) -> str:
        """A short key, kept with maps made by it."""
        ...

    def deviations(self, reference: Reference, trajectories: Trajectories) -> FloatArray:
        """Return (K,) deviations, 0 for equal; `trajectories` has the reference's samples."""
        ...


def reference_of(walk: Walk, dt_s: float) -> Reference:
    """Sample a walk at the follower's steps."""
    count = int(np.floor(walk.duration_s / dt_s + 1e-9)) + 1
    xy_m = walk.at(np.arange(count, dtype=np.float64) * dt_s)
    return Reference(xy_m, dt_s, walk.length_m, walk.duration_s)
