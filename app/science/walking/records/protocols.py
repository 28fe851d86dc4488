"""Protocols of the exchangeable parts: planner, path follower, and metric of deviation.

    Planner       scene, start, goal      -> PlannedPath
    PathFollower  path, K vectors         -> Trajectories   (uses the steering parameters)
    Metric        reference, Trajectories -> K deviations, smaller is better

A follower defines its steering parameters; a grid is made over those. All K agents are simulated
together at steps of `dt_s`, from time 0. The reference is sampled at the same steps.
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
    """Protocol of a planner of paths in one scene; deterministic."""

    def plan(self, start_m: Point, goal_m: Point) -> PlannedPath:
        """Return the path between two points; raise SceneError if there is none."""
        ...


@dataclass(frozen=True)
class Course:
    """The task of an agent: the path to follow and its conditions, without steering parameters.

    Attributes:
        path: the path to follow.
        samples: number of positions to return, at 0, dt, 2 dt, ...: as many as the reference has.
        time_limit_s: an agent that takes longer has not arrived.
        initial_speed_m_s: 0 for a start from rest, else the speed at which the recording begins.
        brakes: whether the agent stops at the goal, or passes it at speed.
    """

    path: PlannedPath
    samples: int
    time_limit_s: float
    initial_speed_m_s: float = 0.0
    brakes: bool = True


@dataclass(frozen=True, eq=False)
class Trajectories:
    """The movements of K agents on one course.

    Attributes:
        xy_m: (K, samples, 2) positions; an agent that has arrived stays at its last position.
        arrival_s: (K,) travel times, NaN for agents that did not arrive in time.
    """

    xy_m: FloatArray
    arrival_s: FloatArray

    @property
    def arrived(self) -> BoolArray:
        """Whether each agent reached the goal in time, (K,)."""
        return np.isfinite(self.arrival_s)


class PathFollower(Protocol):
    """Protocol of a simulation that moves agents along a path; deterministic."""

    @property
    def parameters(self) -> tuple[SteeringParameter, ...]:
        """The n steering parameters, in the order of a vector's columns."""
        ...

    @property
    def dt_s(self) -> float:
        """The time between samples, s."""
        ...

    def follow(self, course: Course, vectors: FloatArray) -> Trajectories:
        """Let one agent for each of the vectors (K, n) follow the course."""
        ...


@dataclass(frozen=True, eq=False)
class Reference:
    """A person's walk sampled at the follower's time steps, with which agents are compared.

    Attributes:
        xy_m: (N, 2) positions at 0, dt, 2 dt, ... up to the end of the walk.
        dt_s: the time step.
        length_m: distance walked.
        duration_s: exact travel time.
    """

    xy_m: FloatArray
    dt_s: float
    length_m: float
    duration_s: float


class Metric(Protocol):
    """Protocol of a measure of how far agents deviate from a reference."""

    @property
    def name(self) -> str:
        """Short key, stored with the maps made by this metric."""
        ...

    def deviations(self, reference: Reference, trajectories: Trajectories) -> FloatArray:
        """Return the deviations (K,), 0 for equal; `trajectories` has the reference's samples."""
        ...


def reference_of(walk: Walk, dt_s: float) -> Reference:
    """Sample a walk at the follower's time steps."""
    count = int(np.floor(walk.duration_s / dt_s + 1e-9)) + 1
    xy_m = walk.at(np.arange(count, dtype=np.float64) * dt_s)
    return Reference(xy_m, dt_s, walk.length_m, walk.duration_s)
