"""The comparisons that a study declares beforehand.

Latency studies ask three things of each measure. Does it differ from 0 ms at each latency, and
which is the first that does (`against_reference`)? Does it fall, or rise, as was predicted
(`directional`)? Both adjust by Holm's rule over exactly the comparisons named here, so comparisons
that nobody declared cost nothing, and none may be added afterwards.
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
    """Every other level against the reference.

    Attributes:
        reference: the level compared with.
        comparisons: in the order of levels; `a` is the level, `b` the reference, so that a positive
            effect says that the measure is larger than at the reference.
        first_that_differs: the first level, in order, whose adjusted p is at most alpha; None if
            none is. It is no threshold: levels between are untested, and a later one may not
            differ.
        alpha: of the whole family.
        alternative: "less" says that a level is below the reference.
    """

    reference: str
    comparisons: tuple[Comparison, ...]
    first_that_differs: str | None
    alpha: float
    alternative: Alternative


@dataclass(frozen=True)
class DirectionalHypothesis:
    """A predicted direction over ordered levels, tested one-sided.

    Attributes:
        predicted: "rises" or "falls" along the levels as ordered.
        p: Page's test in that direction, exact with ties where possible.
        supported: p at most alpha. Whatever the data do, the other direction is no support.
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
        values: (n, k), NaN where missing (pairwise), columns in the order of `levels`.
        reference: one of the levels; "0" and "0.0" name the same number.

    Raises StatisticsError for a reference that is no level, TooFewData without pairs.
    """
    place = place_of(levels, reference)
    pairs = [(other, place) for other in range(len(levels)) if other != place]
    comparisons = compare_pairs(values, levels, pairs, alternative=alternative)
    first = next((one.a for one in comparisons if one.p_holm <= alpha), None)
    return AgainstReference(levels[place], comparisons, first, alpha, alternative)


def directional(
    values: npt.ArrayLike,
    levels: Sequence[str],
    predicted: Direction,
    *,
    alpha: float = 0.05,
) -> DirectionalHypothesis:
    """Test that a measure falls (or rises) along ordered levels; see the result.

    Args:
        values: (n, k), NaN where missing, columns in the order of `levels`.

    Raises StatisticsError for another word than rises or falls, TooFewData.
    """
    if predicted not in ("rises", "falls"):
        raise StatisticsError(f"Direction {predicted!r}; valid: rises, falls.")
    table = np.asarray(values, dtype=np.float64)
    rows, left_out = complete_rows(table)
    # A fall is a rise along the reversed levels.
    trend = page_trend(rows if predicted == "rises" else rows[:, ::-1])
    p = trend.p_given_ties if trend.method == "exact" else trend.p_asymptotic
    alternative: Alternative = "greater" if predicted == "rises" else "less"
    return DirectionalHypothesis(
        predicted=predicted,
        p=p,
        supported=p <= alpha,
        trend=page_trend(rows),
        against_first=against_reference(
            table, levels, levels[0], alternative=alternative, alpha=alpha
        ),
        n_left_out=left_out,
    )
