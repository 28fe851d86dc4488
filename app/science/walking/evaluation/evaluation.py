"""Evaluate models on unseen walks by travel time: the paper's figures, and proper scores.

Each walk is predicted from its planned path and its dependencies alone. All figures use the same
draws: the first one is the paper's single draw, all of them are the predicted distribution.
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
"""Fewest walks of a course from which an interquartile range is computed."""
CYCLE_S, WALKING_SHARE = 100.0, 0.2
"""Duration of the paper's work cycle, and the share of it spent walking."""


@dataclass(frozen=True, eq=False)
class Outcome:
    """The predictions of one model for N walks.

    Attributes:
        model: the name of the model.
        draws_s: (N, S) predicted travel times; S = 1 for models that do not draw.
        crps_s: (N,) score of each prediction.
        lost: number of draws whose agent did not arrive.
    """

    model: str
    draws_s: FloatArray
    crps_s: FloatArray
    lost: int

    @property
    def single_s(self) -> FloatArray:
        """The first draw for each walk, (N,)."""
        first: FloatArray = self.draws_s[:, 0]
        return first

    @property
    def mean_crps_s(self) -> float:
        """Mean CRPS over the walks."""
        return float(self.crps_s.mean())


@dataclass(frozen=True, eq=False)
class Evaluation:
    """The predictions of several models for the same N walks.

    Attributes:
        truth_s: (N,) actual travel times.
        lengths_m: (N,) lengths of the planned paths.
        subjects, courses: the subject and the course of each walk; walks of one course are
            repetitions by one or several people.
        outcomes: the outcome of each model.
    """

    truth_s: FloatArray
    lengths_m: FloatArray
    subjects: tuple[str, ...]
    courses: tuple[str, ...]
    outcomes: dict[str, Outcome]

    def crps_ratio(self, first: str, second: str) -> float:
        """Return the mean CRPS of the first model over that of the second."""
        return self.outcomes[first].mean_crps_s / self.outcomes[second].mean_crps_s

    def errors(self, model: str) -> ErrorSummary:
        """Summarise the absolute travel-time errors of single draws, as in the paper."""
        return error_summary(self.outcomes[model].single_s, self.truth_s)

    def medians(self, model: str) -> ErrorSummary:
        """Summarise the absolute travel-time errors of the predictions' medians."""
        return error_summary(np.median(self.outcomes[model].draws_s, axis=1), self.truth_s)

    def comparisons(self) -> list[Comparison]:
        """Compare each pair of models by the absolute travel-time errors of single draws."""
        return [
            comparison(
                pair,
                np.abs(self.outcomes[pair[0]].single_s - self.truth_s),
                np.abs(self.outcomes[pair[1]].single_s - self.truth_s),
            )
            for pair in combinations(self.outcomes, 2)
        ]

    def iqr_ratios(self, model: str) -> list[float]:
        """Return for each course the interquartile range of predictions over that of the walks.

        Courses with too few walks, or without variation, are left out.
        """
        ratios = []
        for course in sorted(set(self.courses)):
            own = np.array([name == course for name in self.courses])
            spread = iqr(self.truth_s[own])
            if own.sum() >= LEAST_FOR_IQR and spread > 0.0:
                ratios.append(iqr(self.outcomes[model].draws_s[own].ravel()) / spread)
        return ratios

    def coverage(self, model: str) -> tuple[float, ...]:
        """Return the shares of walks within the central 50 and 90 % of their predictions."""
        pairs = list(zip(self.outcomes[model].draws_s, self.truth_s, strict=True))
        return tuple(
            float(np.mean([covers(draws, truth, share) for draws, truth in pairs]))
            for share in COVERAGES
        )

    def saved_per_cycle_s(self, better: str, worse: str) -> float:
        """Return the time by which the better model reduces a work cycle's walking-time error.

        The error is the CRPS relative to the travel time.
        """
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
    """Predict walks with several models and score the predictions.

    Args:
        models: the models, with distinct names.
        follower: the follower with which the models' maps were made.
        walks: the walks of people on whom the models were not fitted; the caller must ensure this.
        rng: random generator for the draws.
        draws: number of draws per walk, for models that draw.
        course_of: function that returns the course of a walk, by default the walk's note; walks of
            the same course are repetitions.

    Raises:
        WalkingError: there are no walks, or a model cannot predict one of them.
    """
    if not walks:
        raise WalkingError("There are no walks to evaluate a model on.")
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
    """Combine evaluations of the same models into one, such as the folds of a cross-validation."""
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
