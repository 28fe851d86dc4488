"""Page's trend test: do the levels rise in the order that was predicted?

With R_j the rank sum of level j (ranked within each of n subjects, ties share the mean rank) and
the levels in the predicted order, L = sum_j j R_j. It is a one-sided test of an order stated
beforehand: mean 1 <= mean 2 <= ... <= mean k, with at least one true inequality.

`p` follows the published tables, as in scipy: P(L' >= floor(L)) over all orders without ties; with
ties that is not the chance of these data, and may be too large or too small. `p_given_ties` is from
the permutation distribution of the observed ranks, which is exact with and without ties. Without
ties the two are equal. `p_asymptotic` is from a normal distribution with mean n k (k + 1)^2 / 4 and
variance n k^2 (k + 1) (k^2 - 1) / 144. Results are reported by `p_rises` and `p_falls`, which are
exact given the ties wherever that can be computed.

Page 1963, J. Am. Stat. Assoc. 58:216-230; van de Wiel and Di Bucchianico 2001, J. Stat. Plan.
Inference 92:1-13.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import permutations
from typing import Literal

import numpy as np
import numpy.typing as npt

from app.science.statistics.arrays import FloatArray, complete_blocks, require_ranks, row_midranks

_EXACT_LEVELS = 7
_EXACT_SUBJECTS = 50


@dataclass(frozen=True)
class PageTrend:
    """The result of Page's test of n subjects at k levels, for a rise and for a fall.

    Attributes:
        statistic: the statistic L of the levels in the given order.
        p: the one-sided p value for a rise, by the tables without ties or asymptotic.
        p_falling: the one-sided p value for a fall: the same test with the order reversed.
        p_given_ties: like `p`, exact for the observed ties; NaN where asymptotic.
        p_falling_given_ties: like `p_falling`, exact for the observed ties; NaN where asymptotic.
        p_asymptotic: like `p`, from the normal distribution.
        method: "exact" up to 7 levels and 50 subjects, else "asymptotic".
    """

    statistic: float
    p: float
    p_falling: float
    p_given_ties: float
    p_falling_given_ties: float
    p_asymptotic: float
    method: Literal["exact", "asymptotic"]
    n: int
    levels: int

    @property
    def p_rises(self) -> float:
        """The p value to report for a rise: exact given the ties, else asymptotic."""
        return self.p_given_ties if self.method == "exact" else self.p

    @property
    def p_falls(self) -> float:
        """The p value to report for a fall: exact given the ties, else asymptotic."""
        return self.p_falling_given_ties if self.method == "exact" else self.p_falling


def page_trend(blocks: npt.ArrayLike) -> PageTrend:
    """Run Page's test on complete blocks (n subjects, k levels in the predicted order).

    Raises ConstantData if every subject has equal values at all levels, TooFewData for too few rows
    or columns, StatisticsError for other unusable values.
    """
    values = complete_blocks(blocks)
    n, k = values.shape
    ranks = row_midranks(values)
    require_ranks(ranks)
    places = np.arange(1.0, k + 1.0)
    statistic = float(ranks.sum(axis=0) @ places)
    highest = n * k * (k + 1) ** 2 / 2.0
    mean = n * k * (k + 1) ** 2 / 4.0
    deviation = math.sqrt(n * k**2 * (k + 1) * (k**2 - 1) / 144.0)
    asymptotic = 0.5 * math.erfc((statistic - mean) / deviation / math.sqrt(2.0))
    exact = k <= _EXACT_LEVELS and n <= _EXACT_SUBJECTS
    return PageTrend(
        statistic=statistic,
        p=_without_ties(n, k, statistic) if exact else asymptotic,
        # Reversing the order changes L to n k (k + 1)^2 / 2 - L.
        p_falling=_without_ties(n, k, highest - statistic) if exact else 1.0 - asymptotic,
        p_given_ties=_with_ties(ranks, statistic) if exact else math.nan,
        p_falling_given_ties=_with_ties(ranks, highest - statistic) if exact else math.nan,
        p_asymptotic=asymptotic,
        method="exact" if exact else "asymptotic",
        n=n,
        levels=k,
    )


def _without_ties(n: int, k: int, statistic: float) -> float:
    least, tails = _tie_free_tails(n, k)
    place = math.floor(statistic) - least
    return float(tails[max(place, 0)])


@lru_cache(maxsize=64)
def _tie_free_tails(n: int, k: int) -> tuple[int, FloatArray]:
    """Return the smallest L, and P(L or more) for it and each larger value."""
    least, row = _row_distribution(tuple(range(2, 2 * k + 2, 2)))
    tails = _tails([row] * n)
    # Doubled values of whole numbers are even.
    return n * least // 2, tails[::2]


def _with_ties(ranks: FloatArray, statistic: float) -> float:
    """Return P(L' >= L) over all orders of each subject's ranks; for a fall, of the reversed L."""
    doubled = np.sort(np.rint(2.0 * ranks).astype(np.int64), axis=1)
    rows = [_row_distribution(tuple(row)) for row in doubled.tolist()]
    tails = _tails([row for _, row in rows])
    return float(tails[round(2.0 * statistic) - sum(least for least, _ in rows)])


@lru_cache(maxsize=1024)
def _row_distribution(doubled: tuple[int, ...]) -> tuple[int, FloatArray]:
    """Return the distribution of one subject's part of 2 L: smallest value and probabilities."""
    orders = np.array(list(permutations(doubled)))
    parts = orders @ np.arange(1, len(doubled) + 1)
    least = int(parts.min())
    return least, np.bincount(parts - least) / parts.size


def _tails(rows: list[FloatArray]) -> FloatArray:
    chances = np.ones(1)
    for row in rows:
        chances = np.convolve(chances, row)
    tails: FloatArray = np.minimum(np.cumsum(chances[::-1])[::-1], 1.0)
    return tails
