"""Confidence intervals of means by Student's t, between and within subjects.

For one condition: mean +- t s / sqrt(n). This assumes approximately normal values and then has
exact coverage, which the bootstrap does not have at a dozen subjects.

To draw the conditions of the same subjects next to each other, another interval is needed: overall
differences between subjects do not matter for comparing conditions, yet widen each condition's
interval. So each subject's own mean is subtracted and the grand mean added; the variance that is
then too small by (k - 1) / k is corrected. Cousineau 2005, Tutor. Quant. Methods Psychol. 1:42-45;
Morey 2008, ibid. 4:61-64.
"""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt
from scipy.special import stdtrit

from app.science.statistics.arrays import FloatArray, complete_blocks
from app.science.statistics.errors import StatisticsError, TooFewData


@dataclass(frozen=True)
class MeanInterval:
    """A mean and its confidence interval, in the unit of the measure.

    Attributes:
        mean, low, high: the mean and the ends of its interval, which is symmetric.
        sd: standard deviation over subjects; for "within", of the values without the subjects'
            means, corrected.
        confidence: the confidence level, 0 to 1.
        n: number of subjects.
        kind: "between" for a single condition; "within" for comparing conditions by eye.
    """

    mean: float
    low: float
    high: float
    sd: float
    confidence: float
    n: int
    kind: Literal["between", "within"]


def mean_interval(values: npt.ArrayLike, *, confidence: float = 0.95) -> MeanInterval:
    """Return the confidence interval of the mean of (n,) values, one per subject.

    NaN values are left out; the result's n counts the rest.

    Raises TooFewData for fewer than 2 values, StatisticsError for a confidence outside 0..1.
    """
    column = np.asarray(values, dtype=np.float64).ravel()
    column = column[~np.isnan(column)]
    if column.size < 2:
        raise TooFewData(f"{column.size} values; an interval needs at least 2.")
    return _interval(column, 1.0, confidence, "between")


def within_subject_intervals(
    blocks: npt.ArrayLike, *, confidence: float = 0.95
) -> tuple[MeanInterval, ...]:
    """Return an interval for each column of complete blocks (n subjects, k conditions).

    Raises the same errors as `mean_interval`, and StatisticsError for missing values.
    """
    values = complete_blocks(blocks)
    k = values.shape[1]
    freed = values - values.mean(axis=1, keepdims=True) + values.mean()
    return tuple(_interval(column, k / (k - 1), confidence, "within") for column in freed.T)


def _interval(
    column: FloatArray, widened: float, confidence: float, kind: Literal["between", "within"]
) -> MeanInterval:
    if not 0.0 < confidence < 1.0:
        raise StatisticsError(f"The confidence is {confidence}; give a number between 0 and 1.")
    n, mean = column.size, float(column.mean())
    sd = math.sqrt(widened) * float(column.std(ddof=1))
    reach = float(stdtrit(n - 1, 0.5 + 0.5 * confidence)) * sd / math.sqrt(n)
    return MeanInterval(mean, mean - reach, mean + reach, sd, confidence, n, kind)
