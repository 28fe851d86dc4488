"""Wilcoxon's signed-rank test: are paired differences centred on zero?

The absolute differences |x - y| are ranked; W+ is the rank sum of the positive ones, W- of the
negative ones. The rule for differences of exactly zero is stated in the result:

    "wilcoxon"   they are left out before ranking (Wilcoxon 1945). The default, and that of R, JASP,
                 pingouin and scipy.
    "pratt"      they are ranked with the others, and then left out (Pratt 1959).

Equal sizes share the mean rank. The exact p is conditional on the observed ranks, ties included:
without an effect each remaining difference is equally likely to be positive or negative, so that W+
has the distribution of a sum of independent terms, 0 or rank, computed by convolution. Two-sided p
is twice the smaller tail, at most 1. The asymptotic p is normal with the variance sum(ranks^2) / 4,
which holds with ties, without continuity correction.

Differences that are equal to 11 digits count as equal: 0.3 - 0.2 and 0.2 - 0.1 share a rank. R's
`wilcox.test` ranks the numbers as the computer holds them (unless `digits.rank` is given), and can
then report another V; `w_plus_unrounded` is that V.

The matched rank-biserial correlation, (W+ - W-) / (W+ + W-), from -1 to 1, is the effect size: the
share of the rank sum in favour of x minus the share against (Kerby 2014, Comprehensive Psychology
3, 11.IT.3.1).

Assumes that pairs are independent of each other, and differences symmetric about their centre.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
import numpy.typing as npt

from app.science.statistics.arrays import DIGITS, FloatArray, comparable, midranks
from app.science.statistics.errors import StatisticsError, TooFewData

EXACT_UP_TO = 50
Alternative = Literal["two-sided", "greater", "less"]
ZeroRule = Literal["wilcoxon", "pratt"]
_ALTERNATIVES = ("two-sided", "greater", "less")
_ZERO_RULES = ("wilcoxon", "pratt")


@dataclass(frozen=True)
class SignedRank:
    """The result of Wilcoxon's signed-rank test of x - y; ranks have no unit.

    Attributes:
        w: the smaller of W+ and W-.
        w_plus, w_minus: rank sums of the positive and of the negative differences.
        p: the p value, computed by `method` for `alternative`.
        p_asymptotic: the p value from the normal approximation, always given in addition.
        rank_biserial: matched, -1 to 1; positive if x is larger. 0 if all differences are zero.
        method: "exact" or "asymptotic".
        alternative: "greater" means that x is larger than y.
        zeros: the rule for differences of zero.
        n: pairs with both values.
        n_zero: pairs among these whose values are equal.
        n_rounded: pairs among those whose values differ, but are equal to 11 digits.
        n_left_out: pairs with a missing value (pairwise).
        w_plus_unrounded: W+ if differences were ranked without rounding; the V of R.
    """

    w: float
    w_plus: float
    w_minus: float
    p: float
    p_asymptotic: float
    rank_biserial: float
    method: Literal["exact", "asymptotic"]
    alternative: Alternative
    zeros: ZeroRule
    n: int
    n_zero: int
    n_rounded: int
    n_left_out: int
    w_plus_unrounded: float

    @property
    def degenerate(self) -> str:
        """Why the test says nothing about these pairs; empty if it can be used."""
        if self.n_zero < self.n:
            return ""
        told = f"all {self.n} differences are zero"
        if not self.n_rounded:
            return told
        return f"{told} to {DIGITS} digits, though {self.n_rounded} of the pairs are not equal"


def signed_rank(
    x: npt.ArrayLike,
    y: npt.ArrayLike,
    *,
    alternative: Alternative = "two-sided",
    zeros: ZeroRule = "wilcoxon",
    exact_up_to: int = EXACT_UP_TO,
) -> SignedRank:
    """Test paired values in the same unit; pairs with a NaN are left out and counted.

    If all differences are zero, p is 1: there is no evidence against the null hypothesis.

    Raises StatisticsError for values that do not pair up or are infinite, and for an unknown
    alternative or zero rule; TooFewData if there is no pair.
    """
    _check_words(alternative, zeros)
    first, second, left_out = _pairs(x, y)
    scale = float(max(np.abs(first).max(), np.abs(second).max()))
    differences = comparable(first - second, scale)
    sizes = np.abs(differences)
    moved = sizes > 0.0
    if zeros == "wilcoxon":
        differences, ranks = differences[moved], midranks(sizes[moved])
    else:
        differences, ranks = differences[moved], midranks(sizes)[moved]
    total = float(ranks.sum())
    plus = float(ranks[differences > 0.0].sum())
    asymptotic = _normal_p(ranks, plus, alternative)
    exact = ranks.size <= exact_up_to
    return SignedRank(
        w=min(plus, total - plus),
        w_plus=plus,
        w_minus=total - plus,
        p=_exact_p(ranks, plus, alternative) if exact else asymptotic,
        p_asymptotic=asymptotic,
        rank_biserial=(2.0 * plus - total) / total if total else 0.0,
        method="exact" if exact else "asymptotic",
        alternative=alternative,
        zeros=zeros,
        n=first.size,
        n_zero=first.size - ranks.size,
        n_rounded=first.size - ranks.size - int((first == second).sum()),
        n_left_out=left_out,
        w_plus_unrounded=_unrounded(first - second, zeros),
    )


def _unrounded(differences: FloatArray, zeros: ZeroRule) -> float:
    """Return W+ of the differences as they are, down to the last binary digit."""
    sizes = np.abs(differences)
    moved = sizes > 0.0
    ranks = midranks(sizes)[moved] if zeros == "pratt" else midranks(sizes[moved])
    return float(ranks[differences[moved] > 0.0].sum())


def _check_words(alternative: str, zeros: str) -> None:
    if alternative not in _ALTERNATIVES:
        raise StatisticsError(
            f"Unknown alternative {alternative!r}; valid: {', '.join(_ALTERNATIVES)}."
        )
    if zeros not in _ZERO_RULES:
        raise StatisticsError(f"Unknown rule for zeros {zeros!r}; valid: {', '.join(_ZERO_RULES)}.")


def _pairs(x: npt.ArrayLike, y: npt.ArrayLike) -> tuple[FloatArray, FloatArray, int]:
    first, second = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    if first.ndim != 1 or first.shape != second.shape:
        raise StatisticsError(
            f"Values of shapes {first.shape} and {second.shape} do not pair up; give two of (n,)."
        )
    paired = ~(np.isnan(first) | np.isnan(second))
    if not paired.any():
        raise TooFewData(f"None of {first.size} pairs has both values; at least one is needed.")
    first, second, left_out = first[paired], second[paired], int(paired.size - paired.sum())
    if not (np.isfinite(first).all() and np.isfinite(second).all()):
        raise StatisticsError("An infinite value was given; only finite values can be ranked.")
    return first, second, left_out


def _exact_p(ranks: FloatArray, plus: float, alternative: Alternative) -> float:
    doubled = np.sort(np.rint(2.0 * ranks).astype(np.int64))
    tails = _upper_tails(doubled.tobytes())
    # The distribution is symmetric about half the total.
    seen, total = round(2.0 * plus), int(doubled.sum())
    if alternative == "greater":
        return float(tails[seen])
    if alternative == "less":
        return float(tails[total - seen])
    return min(1.0, 2.0 * float(tails[max(seen, total - seen)]))


@lru_cache(maxsize=1024)
def _upper_tails(doubled: bytes) -> FloatArray:
    """Return P(2 W+ >= w) for w from 0 to the total, given the doubled ranks as bytes of int64."""
    ranks = np.frombuffer(doubled, dtype=np.int64)
    ways = np.zeros(int(ranks.sum()) + 1)
    ways[0] = 1.0
    top = 0
    for rank in ranks.tolist():
        # The right side is a copy, so nothing is added twice. Counts up to 2^50 are exact.
        ways[rank : top + rank + 1] += ways[: top + 1].copy()
        top += rank
    tails: FloatArray = np.cumsum(ways[::-1])[::-1] / 2.0**ranks.size
    return tails


def _normal_p(ranks: FloatArray, plus: float, alternative: Alternative) -> float:
    if not ranks.size:
        return 1.0
    z = (plus - 0.5 * float(ranks.sum())) / math.sqrt(0.25 * float(np.square(ranks).sum()))
    if alternative == "greater":
        return 0.5 * math.erfc(z / math.sqrt(2.0))
    if alternative == "less":
        return 0.5 * math.erfc(-z / math.sqrt(2.0))
    return min(1.0, math.erfc(abs(z) / math.sqrt(2.0)))
