"""Models against walks that they never saw: travel times, as the paper tells them and properly.

Each walk is predicted from its planned path and its dependencies alone. The same draws serve all
figures: the first one is the paper's single draw, all of them the distribution.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.evaluation.scoring import (
    COVERAGES,
    Comparison,
    ErrorSummary,
    comparison,
    error_summary,
)
from app.science.walking.models import SteeringModel, covers, crps_s, iqr, predictor_for
from app.science.walking.records import PathFollower, PlannedWalk, WalkingError

DRAWS = 200
LEAST_FOR_IQR = 4
"""Walks of one path below which their interquartile range says nothing."""
CYCLE_S, WALKING_SHARE = 100.0, 0.2
"""The paper's work cycle, a fifth of it walking."""


@dataclass(frozen=True, eq=False)
class Outcome:
    """One model on N walks.

    Attributes:
        model: its name.
        draws_s: (N, S) predicted travel times; S = 1 for models that do not draw.
        crps_s: (N,).
        lost: draws that did not arrive.
    """

    model: str
    draws_s: FloatArray
    crps_s: FloatArray
    lost: int

    @property
    def single_s(self) -> FloatArray:
        """(N,) the first draw for each walk."""
        first: FloatArray = self.draws_s[:, 0]
        return first

    @property
    def mean_crps_s(self) -> float:
        """Over the walks."""
        return float(self.crps_s.mean())


@dataclass(frozen=True, eq=False)
class Evaluation:
    """Several models on the same N walks.

    Attributes:
        truth_s: (N,) travel times.
        lengths_m: (N,) of the planned paths.
        subjects, courses: N each; walks of one course are repetitions by one or several people.
        outcomes: by model.
    """

    truth_s: FloatArray
    lengths_m: FloatArray
    subjects: tuple[str, ...]
    courses: tuple[str, ...]
    outcomes: dict[str, Outcome]

    def crps_ratio(self, first: str, second: str) -> float:
        """Mean CRPS of one model over that of another."""
        return self.outcomes[first].mean_crps_s / self.outcomes[second].mean_crps_s

    def errors(self, model: str) -> ErrorSummary:
        """|dt| of single draws, the paper's figures."""
        return error_summary(self.outcomes[model].single_s, self.truth_s)

    def medians(self, model: str) -> ErrorSummary:
        """|dt| of the predicted distributions' medians."""
        return error_summary(np.median(self.outcomes[model].draws_s, axis=1), self.truth_s)

    def comparisons(self) -> list[Comparison]:
        """Single draws' |dt| of each pair of models."""
        return [
            comparison(
                pair,
                np.abs(self.outcomes[pair[0]].single_s - self.truth_s),
                np.abs(self.outcomes[pair[1]].single_s - self.truth_s),
            )
            for pair in combinations(self.outcomes, 2)
        ]

    def iqr_ratios(self, model: str) -> list[float]:
        """For each course the interquartile range of predictions over that of the walks."""
        ratios = []
        for course in sorted(set(self.courses)):
            own = np.array([name == course for name in self.courses])
            spread = iqr(self.truth_s[own])
            if own.sum() >= LEAST_FOR_IQR and spread > 0.0:
                ratios.append(iqr(self.outcomes[model].draws_s[own].ravel()) / spread)
        return ratios

    def coverage(self, model: str) -> tuple[float, ...]:
        """Share of walks within the central 50 and 90 % of what was predicted for them."""
        pairs = list(zip(self.outcomes[model].draws_s, self.truth_s, strict=True))
        return tuple(
            float(np.mean([covers(draws, truth, share) for draws, truth in pairs]))
            for share in COVERAGES
        )

    def saved_per_cycle_s(self, better: str, worse: str) -> float:
        """How much less a work cycle's walking is mispredicted, by CRPS over travel time."""
        gain_s = self.outcomes[worse].mean_crps_s - self.outcomes[better].mean_crps_s
        return CYCLE_S * WALKING_SHARE * gain_s / float(self.truth_s.mean())


def evaluate(
    models: Sequence[SteeringModel],
    follower: PathFollower,
    walks: Sequence[PlannedWalk],
    rng: np.random.Generator,
    *,
    draws: int = DRAWS,
    course_of: Callable[[PlannedWalk], str] = lambda entry: entry.walk.note,
) -> Evaluation:
    """Predict walks with several models.

    Args:
        models: with names that differ.
        follower: that their maps were made with.
        walks: none of a person whom the models were fitted on; that is for the caller to ensure.
        rng: of the draws.
        draws: for each walk, of models that draw.
        course_of: which walks are repetitions of one course; by the walk's note.

    Raises:
        WalkingError: no walks, or a model that cannot predict one of them.
    """
    if not walks:
        raise WalkingError("There is no walk to evaluate a model on.")
    truth_s = np.array([entry.walk.duration_s for entry in walks])
    outcomes = {
        model.name: _outcome(model, follower, walks, truth_s, rng, draws) for model in models
    }
    return Evaluation(
        truth_s,
        np.array([entry.path.length_m for entry in walks]),
        tuple(entry.walk.subject for entry in walks),
        tuple(course_of(entry) for entry in walks),
        outcomes,
    )


def _outcome(
    model: SteeringModel,
    follower: PathFollower,
    walks: Sequence[PlannedWalk],
    truth_s: FloatArray,
    rng: np.random.Generator,
    draws: int,
) -> Outcome:
    found = [
        predictor_for(entry.walk, model, follower).predict(
            entry.path, entry.dependencies, draws, rng
        )
        for entry in walks
    ]
    durations_s = np.stack([one.durations_s for one in found])
    scores = [crps_s(own, truth) for own, truth in zip(durations_s, truth_s, strict=True)]
    return Outcome(model.name, durations_s, np.array(scores), sum(one.lost for one in found))


def pooled(evaluations: Sequence[Evaluation]) -> Evaluation:
    """Several evaluations of the same models as one, such as the folds of a validation."""
    first = evaluations[0]
    outcomes = {}
    for name in first.outcomes:
        parts = [one.outcomes[name] for one in evaluations]
        outcomes[name] = Outcome(
            name,
            np.concatenate([part.draws_s for part in parts]),
            np.concatenate([part.crps_s for part in parts]),
            sum(part.lost for part in parts),
        )
    return Evaluation(
        np.concatenate([one.truth_s for one in evaluations]),
        np.concatenate([one.lengths_m for one in evaluations]),
        tuple(name for one in evaluations for name in one.subjects),
        tuple(name for one in evaluations for name in one.courses),
        outcomes,
    )
