"""Spearman's rank correlation: does one measure rise with another?

rho is the correlation of midranks, from -1 to 1. It relates subjective to objective measures: the
control that people report to the movement of their joints. p is from t = rho sqrt((n - 2) / (1 -
rho^2)) with n - 2 degrees of freedom; the approximation is rough below ten pairs. The interval is
Fisher's z with the standard error sqrt((1 + rho^2 / 2) / (n - 3)).

It takes one pair of values per subject: repeated measures of one subject are not independent, and
must be averaged, or correlated within conditions.

Spearman 1904; Bonett and Wright 2000, Psychometrika 65:23-28.
"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import ndtri, stdtr

from app.science.statistics.arrays import midranks
from app.science.statistics.errors import ConstantData, StatisticsError, TooFewData

_LEAST = 4


@dataclass(frozen=True)
class Spearman:
    """The rank correlation of n pairs.

    Attributes:
        rho: the rank correlation, -1 to 1.
        p: the two-sided p value.
        low, high: ends of the confidence interval.
        confidence: the confidence level, 0 to 1.
        n: pairs with both values; n_left_out: the others (pairwise).
    """

    rho: float
    p: float
    low: float
    high: float
    confidence: float
    n: int
    n_left_out: int


def spearman(x: npt.ArrayLike, y: npt.ArrayLike, *, confidence: float = 0.95) -> Spearman:
    """Correlate two arrays (n,) by ranks; pairs with a NaN are left out and counted.

    Raises StatisticsError for values that do not pair up, TooFewData for fewer than 4 pairs,
    ConstantData if one side is constant.
    """
    first, second = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    if first.ndim != 1 or first.shape != second.shape:
        raise StatisticsError(
            f"Values of shapes {first.shape} and {second.shape} do not pair up; give two of (n,)."
        )
    if not 0.0 < confidence < 1.0:
        raise StatisticsError(f"The confidence is {confidence}; give a number between 0 and 1.")
    paired = ~(np.isnan(first) | np.isnan(second))
    n = int(paired.sum())
    if n < _LEAST:
        raise TooFewData(f"{n} pairs have both values; at least {_LEAST} are needed.")
    ranks = midranks(first[paired]) - 0.5 * (n + 1), midranks(second[paired]) - 0.5 * (n + 1)
    length = math.sqrt(float(ranks[0] @ ranks[0]) * float(ranks[1] @ ranks[1]))
    if length <= 0.0:
        raise ConstantData(f"One of the two measures is the same in all {n} pairs.")
    rho = max(-1.0, min(1.0, float(ranks[0] @ ranks[1]) / length))
    low, high = _interval(rho, n, confidence)
    return Spearman(rho, _p(rho, n), low, high, confidence, n, paired.size - n)


def _p(rho: float, n: int) -> float:
    left = 1.0 - rho * rho
    if left <= 1e-15:
        return 0.0
    return 2.0 * float(stdtr(n - 2, -abs(rho) * math.sqrt((n - 2) / left)))


def _interval(rho: float, n: int, confidence: float) -> tuple[float, float]:
    if abs(rho) >= 1.0 - 1e-15:
        return rho, rho
    reach = float(ndtri(0.5 + 0.5 * confidence)) * math.sqrt((1.0 + 0.5 * rho * rho) / (n - 3))
    z = math.atanh(rho)
    return math.tanh(z - reach), math.tanh(z + reach)
