"""Bootstrap confidence intervals, corrected for bias and skew (BCa).

Subjects are drawn with replacement, the statistic is computed for each draw, and the ends of the
interval are percentiles of these values, shifted by the statistic's bias and by how its spread
changes with its value (acceleration, from leaving out one subject at a time). Efron 1987, J. Am.
Stat. Assoc. 82:171-185; computed by scipy.stats.bootstrap.

With a dozen subjects the intervals are too narrow: for the mean, at n = 12, a 95 % interval covered
the true value in 90 % of normal and 89 % of skewed (gamma) samples. So means have Student's
interval instead (`mean_intervals`), and this is for statistics that have no other.
"""

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from app.science.statistics.arrays import FloatArray
from app.science.statistics.errors import StatisticsError, TooFewData

Statistic = Callable[[FloatArray], FloatArray]
_BATCH = 1000


@dataclass(frozen=True)
class Interval:
    """A confidence interval, in the unit of the statistic.

    Attributes:
        estimate: the statistic of the data as observed.
        low, high: the ends of the interval.
        confidence: the confidence level, 0 to 1.
        method: "BCa", or "percentile" where BCa is not defined (the acceleration cannot be computed
            from leaving out subjects).
        resamples: number of draws.
        n: number of subjects.
    """

    estimate: float
    low: float
    high: float
    confidence: float
    method: Literal["BCa", "percentile"]
    resamples: int
    n: int


def bootstrap_interval(
    data: npt.ArrayLike,
    statistic: Statistic,
    *,
    rng: np.random.Generator,
    confidence: float = 0.95,
    resamples: int = 4999,
) -> Interval:
    """Return the confidence interval of a statistic of subjects.

    Args:
        data: (n, ...) complete values, one entry per subject.
        statistic: function that computes the statistic of many draws at once: it takes (draws, n,
            ...) and returns (draws,).
        rng: seeded by the caller, so that the interval is reproducible.

    Raises TooFewData for fewer than 2 subjects, StatisticsError for a confidence outside 0..1 or a
    statistic that is not finite.
    """
    rows = np.asarray(data, dtype=np.float64)
    if rows.ndim < 1 or rows.shape[0] < 2:
        raise TooFewData(f"Data of shape {rows.shape}: at least 2 subjects are needed.")
    if not 0.0 < confidence < 1.0:
        raise StatisticsError(f"The confidence is {confidence}; give a number between 0 and 1.")
    n = rows.shape[0]
    estimate = float(statistic(rows[np.newaxis])[0])
    if not math.isfinite(estimate):
        raise StatisticsError(f"The statistic of the data is {estimate}; it must be finite.")
    low, high, bca = _ends(rows, statistic, rng, confidence, resamples)
    method: Literal["BCa", "percentile"] = "BCa" if bca else "percentile"
    return Interval(estimate, low, high, confidence, method, resamples, n)


def _ends(
    rows: FloatArray,
    statistic: Statistic,
    rng: np.random.Generator,
    confidence: float,
    resamples: int,
) -> tuple[float, float, bool]:
    from scipy import stats

    def of_places(places: npt.NDArray[np.intp], axis: int) -> FloatArray:
        drawn = np.moveaxis(places, axis, -1)
        values = statistic(rows[drawn.reshape(-1, drawn.shape[-1])])
        return values.reshape(drawn.shape[:-1])

    with warnings.catch_warnings():
        # A degenerate distribution is handled below, by percentiles.
        warnings.simplefilter("ignore")
        found = stats.bootstrap(
            (np.arange(rows.shape[0]),),
            of_places,
            n_resamples=resamples,
            batch=_BATCH,
            confidence_level=confidence,
            method="BCa",
            rng=rng,
        )
    low, high = float(found.confidence_interval.low), float(found.confidence_interval.high)
    if math.isfinite(low) and math.isfinite(high):
        return low, high, True
    tail = 50.0 * (1.0 - confidence)
    drawn = found.bootstrap_distribution
    drawn = drawn[np.isfinite(drawn)]
    low, high = np.percentile(drawn, (tail, 100.0 - tail))
    return float(low), float(high), False


def mean_of(draws: FloatArray) -> FloatArray:
    """Return the mean over subjects, as a statistic for `bootstrap_interval`."""
    found: FloatArray = draws.mean(axis=1)
    return found


def median_of(draws: FloatArray) -> FloatArray:
    """Return the median over subjects, as a statistic for `bootstrap_interval`."""
    found: FloatArray = np.median(draws, axis=1)
    return found
