"""Evaluate models on unseen walks by travel time: the paper's figures, and proper scores.

Each walk is predicted from its planned path and its dependencies alone. All figures use the same
draws: the first one is the paper's single draw, all of them are the predicted distribution.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.evaluation.scoring import (
    COVERAGES,
    Comparison,
    ErrorSummary,
    comparison,
    error_summary,
    over_people,
)
from app.science.walking.models import (
    SteeringModel,
    TravelTimeModel,
    covers,
    crps_s,
    iqr,
    predictor_for,
)
from app.science.walking.records import PathFollower, PlannedWalk, WalkingError
from app.science.walking.travel_times import resting_of

DRAWS = 200
PAPERS = ("stat", "adapt", "prob")
"""The paper's models, which are also compared by its own tests."""
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
        left_out: by the index of the walk that was given, why a model cannot predict it; such a
            walk is in no outcome, so that all models are compared on the same walks.
    """

    truth_s: FloatArray
    lengths_m: FloatArray
    subjects: tuple[str, ...]
    courses: tuple[str, ...]
    outcomes: dict[str, Outcome]
    left_out: Mapping[int, str] = field(default_factory=dict)

    def crps_ratio(self, first: str, second: str) -> float:
        """Return the mean CRPS of the first model over that of the second."""
        return self.outcomes[first].mean_crps_s / self.outcomes[second].mean_crps_s

    def errors(self, model: str) -> ErrorSummary:
        """Summarise the absolute travel-time errors of single draws, as in the paper."""
        return error_summary(self.outcomes[model].single_s, self.truth_s)

    def medians(self, model: str) -> ErrorSummary:
        """Summarise the absolute travel-time errors of the predictions' medians."""
        return error_summary(np.median(self.outcomes[model].draws_s, axis=1), self.truth_s)

    def better_by_s(
        self, first: str, second: str, rng: np.random.Generator
    ) -> tuple[float, float, float]:
        """Return by how much the first model's CRPS is smaller, with a 95 % interval over people.

        Whole people are drawn again, because walks of one person are not independent.
        """
        gain = self.outcomes[second].crps_s - self.outcomes[first].crps_s
        return float(gain.mean()), *over_people(gain, self.subjects, rng)

    @property
    def people(self) -> int:
        """The number of people."""
        return len(set(self.subjects))

    def comparisons(self, *, by_person: bool = False) -> list[Comparison]:
        """Compare each pair of the paper's models by the errors of single draws.

        As in the paper each walk is a pair of errors. Walks of one person are not independent;
        `by_person` compares the mean error of each person instead.
        """
        found = []
        for pair in combinations([name for name in PAPERS if name in self.outcomes], 2):
            first, second = (np.abs(self.outcomes[name].single_s - self.truth_s) for name in pair)
            if by_person:
                first, second = self._of_people(first), self._of_people(second)
            found.append(comparison(pair, first, second))
        return found

    def _of_people(self, values: FloatArray) -> FloatArray:
        """Return the mean over each person's walks of values (N,), one per person."""
        _, person = np.unique(np.array(self.subjects), return_inverse=True)
        means: FloatArray = np.bincount(person, weights=values) / np.bincount(person)
        return means

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
        WalkingError: there are no walks, or none that all models can predict.
    """
    if not walks:
        raise WalkingError("There are no walks to evaluate a model on.")
    left_out: dict[int, str] = {}
    predicted = {
        model.name: _predicted(model, follower, walks, rng, draws, left_out) for model in models
    }
    kept = [at for at in range(len(walks)) if at not in left_out]
    if not kept:
        first = min(left_out)
        raise WalkingError(
            f"None of the {len(walks)} walks can be predicted by all models; of the first:"
            f" {left_out[first]}"
        )
    entries = [walks[at] for at in kept]
    truth_s = np.array([entry.walk.duration_s for entry in entries])
    outcomes = {}
    for name, (rows, lost) in predicted.items():
        draws_s = np.stack([rows[at] for at in kept])
        scores = [crps_s(own, truth) for own, truth in zip(draws_s, truth_s, strict=True)]
        outcomes[name] = Outcome(name, draws_s, np.array(scores), sum(lost[at] for at in kept))
    return Evaluation(
        truth_s,
        np.array([entry.path.length_m for entry in entries]),
        tuple(entry.walk.subject for entry in entries),
        tuple(course_of(entry) for entry in entries),
        outcomes,
        left_out,
    )


def _predicted(
    model: SteeringModel,
    follower: PathFollower,
    walks: Sequence[PlannedWalk],
    rng: np.random.Generator,
    draws: int,
    left_out: dict[int, str],
) -> tuple[dict[int, FloatArray], dict[int, int]]:
    """Return travel times (S,) and lost draws by walk; add those it cannot predict to left_out."""
    rows: dict[int, FloatArray] = {}
    lost: dict[int, int] = {}
    for at, entry in enumerate(walks):
        if isinstance(model, TravelTimeModel):
            resting = resting_of(entry)
            rows[at] = model.durations_s(
                entry.path, entry.dependencies, draws, rng, resting=resting
            )
            lost[at] = 0
            continue
        predictor = predictor_for(entry.walk, model, follower)
        try:
            found = predictor.predict(entry.path, entry.dependencies, draws, rng)
        except WalkingError as error:
            left_out.setdefault(at, str(error))
        else:
            rows[at], lost[at] = found.durations_s, found.lost
    return rows, lost


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
        _numbered([(len(one.truth_s), one.left_out) for one in evaluations]),
    )


def _numbered(parts: Sequence[tuple[int, Mapping[int, str]]]) -> dict[int, str]:
    """Number the walks that were left out as if all parts' walks had been given at once."""
    found: dict[int, str] = {}
    before = 0
    for kept, left_out in parts:
        found |= {before + at: reason for at, reason in left_out.items()}
        before += kept + len(left_out)
    return found
