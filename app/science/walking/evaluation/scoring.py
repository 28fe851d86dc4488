"""Summarise errors of travel times as in the paper, and compare two models by them.

The paper takes one draw and compares the absolute error of the travel time, |dt|. That penalises
realistic variation: where walks differ, a draw from their true distribution is off by about sqrt 2
times as much as the distribution's median, so a model that ignores variation wins. The models are
therefore judged by the score in `crps`. SciPy is slow to import, so only the functions that need it
import it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records import WalkingError

PERCENTILES = (5.0, 25.0, 50.0, 75.0, 95.0)
"""Percentiles of errors that the paper reports."""
COVERAGES = (0.5, 0.9)
ALPHA = 0.05
RESAMPLED = 4000
LEAST_PEOPLE = 6
"""Fewest people from whom an interval is given, or a test: with five, a two-sided signed-rank test
reaches a p of .0625 at best, and a bootstrap of one has no width."""
EFFICIENCY = 0.864
"""Lower bound of the signed-rank test's efficiency relative to the t test (Hodges, Lehmann)."""


@dataclass(frozen=True)
class ErrorSummary:
    """Absolute travel-time errors, summarised as in the paper.

    Attributes:
        count: number of errors.
        percentiles_s: the percentiles of the errors at `PERCENTILES`.
        shapiro_p: p of the Shapiro-Wilk test of normality; NaN for fewer than three errors, or if
            all are equal.
        mean_signed_s: mean of prediction minus truth.
    """

    count: int
    percentiles_s: tuple[float, ...]
    shapiro_p: float
    mean_signed_s: float

    @property
    def median_s(self) -> float:
        """Median of the absolute errors."""
        return self.percentiles_s[PERCENTILES.index(50.0)]


def error_summary(predicted_s: FloatArray, truth_s: FloatArray) -> ErrorSummary:
    """Summarise the errors of one prediction per walk, (N,); raise WalkingError without walks."""
    from scipy import stats

    if not len(truth_s) or predicted_s.shape != truth_s.shape:
        raise WalkingError(
            f"{predicted_s.shape} predictions and {truth_s.shape} walks cannot be summarised: give"
            " one prediction (N,) for each walk."
        )
    signed = predicted_s - truth_s
    errors = np.abs(signed)
    p = np.nan
    if len(errors) >= 3 and np.ptp(errors) > 0.0:
        # Its p is only approximate beyond 5000 values, and practically zero there.
        p = float(stats.shapiro(errors[:5000]).pvalue)
    percentiles = tuple(float(value) for value in np.percentile(errors, PERCENTILES))
    return ErrorSummary(len(errors), percentiles, p, float(signed.mean()))


def reason_for_no_interval(people: int) -> str | None:
    """Return why so few people get neither an interval nor a test; None if they are enough."""
    if people >= LEAST_PEOPLE:
        return None
    counted = f"{people} {'person' if people == 1 else 'people'}"
    return (
        f"walks of one person are not independent, and {counted} cannot say how much people differ;"
        f" {LEAST_PEOPLE} are needed"
    )


def over_people(
    values: FloatArray,
    subjects: Sequence[str],
    rng: np.random.Generator,
    *,
    level: float = 0.95,
    draws: int = RESAMPLED,
) -> tuple[float, float]:
    """Return an interval of the mean of values (N,), one per walk, by drawing people again.

    A bootstrap of whole people. With few of them it is too narrow; with one it has no width. It is
    not to be reported if there is a `reason_for_no_interval`.
    """
    _, person = np.unique(np.array(subjects), return_inverse=True)
    count = np.bincount(person)
    total = np.bincount(person, weights=values)
    chosen = rng.integers(0, len(count), (draws, len(count)))
    means = total[chosen].sum(axis=1) / count[chosen].sum(axis=1)
    low, high = np.quantile(means, ((1.0 - level) / 2.0, (1.0 + level) / 2.0))
    return float(low), float(high)


@dataclass(frozen=True)
class Comparison:
    """Two models compared on the same walks by Wilcoxon's signed-rank test.

    Attributes:
        first, second: the names of the two models.
        p: the two-sided p value.
        rank_biserial: positive if the first model has larger errors.
        power: probability of detecting an effect as large as observed, see `signed_rank_power`.
        difference_s: mean of first minus second.
        ties: walks on which both models have the same error.
    """

    first: str
    second: str
    p: float
    rank_biserial: float
    power: float
    difference_s: float
    ties: int


def comparison(names: tuple[str, str], first_s: FloatArray, second_s: FloatArray) -> Comparison:
    """Compare two models' errors, or scores, (N,) of the same walks by the signed-rank test."""
    from app.science.statistics import signed_rank

    test = signed_rank(first_s, second_s)
    apart = first_s - second_s
    spread = float(apart.std(ddof=1)) if len(apart) > 1 else 0.0
    effect = float(apart.mean()) / spread if spread > 0.0 else 0.0
    power = signed_rank_power(len(apart), effect)
    mean = float(apart.mean())
    return Comparison(*names, test.p, test.rank_biserial, power, mean, test.n_zero)


def signed_rank_power(pairs: int, effect: float, alpha: float = ALPHA) -> float:
    """Return the power of the two-sided signed-rank test, as G*Power computes it (A.R.E. method).

    It is that of a paired t test with EFFICIENCY times as many pairs. Power computed from the
    observed effect adds no information to p; it is computed because the paper reports it.

    Args:
        pairs: the number of pairs.
        effect: mean difference over the standard deviation of differences.
        alpha: the significance level of the test.
    """
    from scipy import special

    usable = pairs * EFFICIENCY
    if usable <= 1.0:
        return alpha
    freedom, off_centre = usable - 1.0, abs(effect) * np.sqrt(usable)
    critical = float(special.stdtrit(freedom, 1.0 - alpha / 2.0))
    beyond = 1.0 - float(special.nctdtr(freedom, off_centre, critical))
    below = float(special.nctdtr(freedom, off_centre, -critical))
    total = beyond + (0.0 if np.isnan(below) else below)
    return float(min(1.0, max(alpha, total)))


def mean_of(values: Sequence[float]) -> float:
    """Return the mean of numbers; NaN if there are none."""
    return float(np.mean(values)) if len(values) else float("nan")
