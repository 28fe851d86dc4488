"""Comparisons of every pair of levels, adjusted by Holm's method.

They follow Friedman's test: exact signed-rank tests of all k (k - 1) / 2 pairs. A subject with a
missing level still counts in the pairs of the others (pairwise), and each comparison gives the
number left out of it.

Holm's step-down adjustment (`holm`): sort m p values; the smallest is multiplied by m, the next by
m - 1, and so on; none may be smaller than the previous one, and none exceeds 1. Rejecting if the
adjusted p is at most alpha keeps the probability of any false rejection at alpha, whatever the
dependence between the tests. Holm 1979, Scandinavian Journal of Statistics 6:65-70.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import numpy.typing as npt

from app.science.statistics.errors import StatisticsError, TooFewData
from app.science.statistics.signed_rank import Alternative, SignedRank, ZeroRule, signed_rank


def holm(p_values: Sequence[float]) -> tuple[float, ...]:
    """Return the p values adjusted by Holm's method, in the given order.

    NaN (a test that could not be computed) stays NaN and does not count among the m.

    Raises StatisticsError for a p outside 0..1.
    """
    wrong = [p for p in p_values if not math.isnan(p) and not 0.0 <= p <= 1.0]
    if wrong:
        raise StatisticsError(f"{wrong[0]} is not a p value; give values between 0 and 1.")
    adjusted = [math.nan] * len(p_values)
    computed = sorted((p, place) for place, p in enumerate(p_values) if not math.isnan(p))
    highest = 0.0
    for step, (p, place) in enumerate(computed):
        highest = max(highest, min(1.0, p * (len(computed) - step)))
        adjusted[place] = highest
    return tuple(adjusted)


@dataclass(frozen=True)
class Comparison:
    """The comparison of level `a` with level `b`.

    Attributes:
        a, b: the levels; positive effects mean that a is larger.
        test: the signed-rank test of a - b, with n and the number left out.
        p_holm: the p value of the test, adjusted for all comparisons made together.
        median_difference: the median of a - b over the pairs, in the unit of the measure.
    """

    a: str
    b: str
    test: SignedRank
    p_holm: float
    median_difference: float


def pairwise(
    values: npt.ArrayLike,
    levels: Sequence[str],
    *,
    zeros: ZeroRule = "wilcoxon",
) -> tuple[Comparison, ...]:
    """Compare all pairs of levels of (n, k) values, NaN where missing, in the order of the levels.

    Raises StatisticsError if the levels do not fit the columns, TooFewData if a pair of levels has
    no subject with both.
    """
    return compare_pairs(values, levels, tuple(combinations(range(len(levels)), 2)), zeros=zeros)


def compare_pairs(
    values: npt.ArrayLike,
    levels: Sequence[str],
    pairs: Sequence[tuple[int, int]],
    *,
    alternative: Alternative = "two-sided",
    zeros: ZeroRule = "wilcoxon",
) -> tuple[Comparison, ...]:
    """Compare the given pairs of columns, and adjust for exactly these comparisons.

    Raises the same errors as `pairwise`.
    """
    table = np.asarray(values, dtype=np.float64)
    if table.ndim != 2 or table.shape[1] != len(levels):
        raise StatisticsError(
            f"Values of shape {table.shape} do not fit {len(levels)} levels; give one column each."
        )
    tests = []
    for a, b in pairs:
        try:
            tests.append(
                signed_rank(table[:, a], table[:, b], alternative=alternative, zeros=zeros)
            )
        except TooFewData as error:
            raise TooFewData(f"Levels {levels[a]!r} and {levels[b]!r}: {error}") from error
    adjusted = holm([test.p for test in tests])
    return tuple(
        Comparison(levels[a], levels[b], test, p, _median(table[:, a] - table[:, b]))
        for (a, b), test, p in zip(pairs, tests, adjusted, strict=True)
    )


def _median(differences: npt.NDArray[np.float64]) -> float:
    return float(np.median(differences[~np.isnan(differences)]))
