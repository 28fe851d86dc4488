"""The comparisons that a study declares beforehand.

Latency studies ask several questions of each measure. Does it differ from 0 ms at each latency, and
which is the first that does (`against_reference`)? Does it fall, or rise, as predicted
(`directional`)? Both adjust by Holm's method over exactly the declared comparisons: undeclared ones
cost no power, and none may be added afterwards.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from app.science.statistics.arrays import complete_rows
from app.science.statistics.errors import StatisticsError
from app.science.statistics.levels import place_of
from app.science.statistics.page import PageTrend, page_trend
from app.science.statistics.pairwise import Comparison, compare_pairs
from app.science.statistics.signed_rank import Alternative

Direction = Literal["rises", "falls"]


@dataclass(frozen=True)
class AgainstReference:
    """The comparisons of every other level with the reference.

    Attributes:
        reference: the level with which the others are compared.
        comparisons: the comparisons in the order of levels; `a` is the level, `b` the reference, so
            that a positive effect means that the measure is larger than at the reference.
        first_that_differs: the first level, in order, whose adjusted p is at most alpha; None if
            there is none. It is not a threshold: levels in between are untested, and a later one
            may not differ.
        alpha: the significance level of the whole family.
        alternative: "less" means that a level is below the reference.
    """

    reference: str
    comparisons: tuple[Comparison, ...]
    first_that_differs: str | None
    alpha: float
    alternative: Alternative


@dataclass(frozen=True)
class DirectionalHypothesis:
    """The test of a predicted direction over ordered levels, one-sided.

    Attributes:
        predicted: "rises" or "falls" along the levels as ordered.
        p: Page's test in that direction, exact with ties where possible.
        supported: whether p is at most alpha. An effect in the other direction is never support.
        trend: Page's test with both directions.
        against_first: one-sided comparisons with the first level.
        n_left_out: subjects without all levels (listwise, for the trend).
    """

    predicted: Direction
    p: float
    supported: bool
    trend: PageTrend
    against_first: AgainstReference
    n_left_out: int


def against_reference(
    values: npt.ArrayLike,
    levels: Sequence[str],
    reference: str,
    *,
    alternative: Alternative = "two-sided",
    alpha: float = 0.05,
) -> AgainstReference:
    """Compare each level with the reference by exact signed-rank tests, Holm over all of them.

    Args:
        values: (n, k) values, NaN where missing (pairwise), columns in the order of `levels`.
        reference: one of the levels; "0" and "0.0" name the same number.

    Raises StatisticsError for an unknown reference, TooFewData if a level has no pairs.
    """
    place = place_of(levels, reference)
    pairs = [(other, place) for other in range(len(levels)) if other != place]
    comparisons = compare_pairs(values, levels, pairs, alternative=alternative)
    first = next((comparison.a for comparison in comparisons if comparison.p_holm <= alpha), None)
    return AgainstReference(levels[place], comparisons, first, alpha, alternative)


def directional(
    values: npt.ArrayLike,
    levels: Sequence[str],
    predicted: Direction,
    *,
    alpha: float = 0.05,
) -> DirectionalHypothesis:
    """Test whether a measure falls (or rises) along ordered levels, as predicted.

    Args:
        values: (n, k) values, NaN where missing, columns in the order of `levels`.

    Raises StatisticsError for a direction other than rises or falls, TooFewData for too few data.
    """
    if predicted not in ("rises", "falls"):
        raise StatisticsError(f"The direction {predicted!r} is unknown; valid: rises, falls.")
    table = np.asarray(values, dtype=np.float64)
    rows, left_out = complete_rows(table)
    trend = page_trend(rows)
    p = trend.p_rises if predicted == "rises" else trend.p_falls
    alternative: Alternative = "greater" if predicted == "rises" else "less"
    return DirectionalHypothesis(
        predicted=predicted,
        p=p,
        supported=p <= alpha,
        trend=trend,
        against_first=against_reference(
            table, levels, levels[0], alternative=alternative, alpha=alpha
        ),
        n_left_out=left_out,
    )
