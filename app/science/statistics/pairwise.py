"""Every pair of levels against each other, adjusted by Holm's rule.

Which follows Friedman's test: exact signed-rank tests of all k (k - 1) / 2 pairs. A subject of whom
one level is missing still counts in the pairs of the others (pairwise), and each comparison says
how many were left out of it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import numpy.typing as npt

from app.science.statistics.errors import StatisticsError, TooFewData
from app.science.statistics.holm import holm
from app.science.statistics.signed_rank import Alternative, SignedRank, ZeroRule, signed_rank


@dataclass(frozen=True)
class Comparison:
    """Level `a` against level `b`.

    Attributes:
        a, b: the levels; positive effects say that a is larger.
        test: the signed-rank test of a - b, with n and what was left out.
        p_holm: its p, adjusted for all comparisons made together.
        median_difference: of a - b over the pairs, in the unit of the measure.
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
    """Compare the pairs of columns named, and adjust for exactly these. Raises as `pairwise`."""
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
