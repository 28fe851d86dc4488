"""Predict a distribution of travel times, and walks, from a model and a path.

Vectors of parameters are drawn, and an agent walks the path with each. Agents that do not arrive,
because their turns are too wide or they are too slow, give no walk; they are drawn again and
counted, so the prediction is conditional on arrival. A model that does not draw gives its next best
vector instead, if it has one.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.models.steering_models import SteeringModel
from app.science.walking.models.travel_time_model import TravelTimeModel
from app.science.walking.records import (
    Course,
    PathFollower,
    PlannedPath,
    Trajectories,
    Walk,
    WalkingError,
)

EXTRA_S, SLOWEST_S_PER_M = 10.0, 12.0
"""Time limit of an agent: 10 s, plus 12 s per metre, slower than the grid's slowest."""
ROUNDS, ALTERNATIVES = 20, 200
_ADJUSTED = 3
"""How often agents are slowed down or sped up towards a drawn travel time."""


def slowest_s(length_m: float) -> float:
    """Return the longest time that an agent may take for a path."""
    return EXTRA_S + SLOWEST_S_PER_M * length_m


class TooFewArriveError(WalkingError):
    """A model's agents do not arrive on a path, so that it predicts no walk there."""


@dataclass(frozen=True, eq=False)
class Prediction:
    """Walks that a model predicts on a path.

    Attributes:
        vectors: (S, n) steering parameters of the agents that arrived.
        durations_s: (S,) travel times of these agents.
        lost: number of draws whose agent did not arrive.
    """

    vectors: FloatArray
    durations_s: FloatArray
    lost: int


@dataclass(frozen=True, eq=False)
class Predictor:
    """Predicts walks with one model and one follower.

    Attributes:
        model: the model that gives the vectors.
        follower: the follower with which the model's maps were made.
        begin_m_s, brakes: 0 and True from rest to rest; otherwise the walk is part of a longer one.
    """

    model: SteeringModel
    follower: PathFollower
    begin_m_s: float = 0.0
    brakes: bool = True

    def predict(
        self,
        path: PlannedPath,
        dependencies: Mapping[str, float],
        count: int,
        rng: np.random.Generator,
    ) -> Prediction:
        """Draw `count` walks along a path; models that do not draw give one.

        Raises:
            TooFewArriveError: too few agents have arrived after `ROUNDS` rounds.
        """
        found = (
            self._drawn(path, dependencies, count, rng)
            if self.model.draws
            else self._best(path, dependencies, rng)
        )
        if len(found.durations_s) < (count if self.model.draws else 1):
            raise TooFewArriveError(
                f"Only {len(found.durations_s)} of {len(found.durations_s) + found.lost} agents of"
                f" model {self.model.name} arrive on a path of {path.length_m:.2f} m: it is too"
                " winding, or too far from the walks that the model was fitted on."
            )
        return found

    def _drawn(
        self,
        path: PlannedPath,
        dependencies: Mapping[str, float],
        count: int,
        rng: np.random.Generator,
    ) -> Prediction:
        vectors: list[FloatArray] = []
        durations: list[FloatArray] = []
        missing, lost = count, 0
        for _ in range(ROUNDS):
            if isinstance(self.model, TravelTimeModel):
                drawn, arrival_s = self._timed(self.model, path, dependencies, missing, rng)
            else:
                drawn = self.model.vectors(dependencies, missing, rng)
                arrival_s = self.walked(path, drawn, samples=1).arrival_s
            arrived = np.isfinite(arrival_s)
            vectors.append(drawn[arrived])
            durations.append(arrival_s[arrived])
            lost += missing - len(durations[-1])
            missing -= len(durations[-1])
            if not missing:
                break
        return Prediction(np.concatenate(vectors), np.concatenate(durations), lost)

    def _timed(
        self,
        model: TravelTimeModel,
        path: PlannedPath,
        dependencies: Mapping[str, float],
        count: int,
        rng: np.random.Generator,
    ) -> tuple[FloatArray, FloatArray]:
        """Draw travel times and agents that take them; a time is NaN if its agent gets lost."""
        resting = ((self.begin_m_s == 0.0) + self.brakes) / 2.0
        durations_s, vectors = model.agents(
            path.length_m, dependencies, count, rng, resting=resting
        )
        for _ in range(_ADJUSTED):
            arrival_s = self.walked(path, vectors, samples=1).arrival_s
            faster = np.nan_to_num(arrival_s / durations_s, nan=1.0)[:, None]
            vectors = vectors * np.concatenate([faster, faster**2, np.ones_like(faster)], axis=1)
        return vectors, np.where(np.isfinite(arrival_s), durations_s, np.nan)

    def _best(
        self, path: PlannedPath, dependencies: Mapping[str, float], rng: np.random.Generator
    ) -> Prediction:
        for count in (1, ALTERNATIVES):
            vectors = self.model.vectors(dependencies, count, rng)
            arrival_s = self.walked(path, vectors, samples=1).arrival_s
            arrived = np.flatnonzero(np.isfinite(arrival_s))
            if len(arrived):
                first = slice(arrived[0], arrived[0] + 1)
                return Prediction(vectors[first], arrival_s[first], int(arrived[0]))
        return Prediction(vectors[:0], arrival_s[:0], len(vectors))

    def walked(self, path: PlannedPath, vectors: FloatArray, samples: int) -> Trajectories:
        """Let agents with vectors (S, n) walk a path, from this predictor's initial speed."""
        limit_s = slowest_s(path.length_m)
        course = Course(path, samples, limit_s, self.begin_m_s, self.brakes)
        return self.follower.follow(course, vectors)


def predictor_for(walk: Walk, model: SteeringModel, follower: PathFollower) -> Predictor:
    """Return a predictor for a recorded walk, which starts or ends at speed if it was cut off."""
    begin_m_s = 0.0 if walk.begins_still else float(walk.speeds_m_s[0])
    return Predictor(model, follower, begin_m_s, walk.ends_still)
