"""Tests of signed ranks, Holm's adjustment and pairwise comparisons."""

import math
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from app.science.statistics import StatisticsError, TooFewData, holm, pairwise, signed_rank
from app.science.statistics.arrays import FloatArray, midranks
from app.science.statistics.signed_rank import Alternative, ZeroRule

_DRAWN = settings(max_examples=60, deadline=None)
_DIFFERENCES = st.lists(st.integers(-4, 4), min_size=1, max_size=8)
_P_VALUES = st.lists(st.floats(0.0, 1.0), min_size=1, max_size=8)


def _by_brute_force(differences: FloatArray, alternative: Alternative, zeros: ZeroRule) -> float:
    """Return the share of all assignments of signs that are at least as extreme."""
    moved = differences != 0.0
    sizes = np.abs(differences)
    ranks = midranks(sizes[moved]) if zeros == "wilcoxon" else midranks(sizes)[moved]
    seen = ranks[differences[moved] > 0.0].sum()
    sums = np.array([np.dot(ranks, signs) for signs in product((0.0, 1.0), repeat=ranks.size)])
    upper, lower = float(np.mean(sums >= seen - 1e-9)), float(np.mean(sums <= seen + 1e-9))
    if alternative == "two-sided":
        return min(1.0, 2.0 * min(upper, lower))
    return upper if alternative == "greater" else lower


@_DRAWN
@given(
    _DIFFERENCES,
    st.sampled_from(["two-sided", "greater", "less"]),
    st.sampled_from(["wilcoxon", "pratt"]),
)
def test_the_exact_p_is_that_of_every_assignment_of_signs(
    differences: list[int], alternative: Alternative, zeros: ZeroRule
) -> None:
    """The exact signed-rank p equals the enumeration of all signs, with ties and zeros."""
    x = np.array(differences, dtype=np.float64)
    test = signed_rank(x, np.zeros_like(x), alternative=alternative, zeros=zeros)
    assert test.method == "exact"
    assert test.p == pytest.approx(_by_brute_force(x, alternative, zeros), abs=1e-12)


@_DRAWN
@given(_DIFFERENCES)
def test_turning_the_pairs_round_turns_the_effect_round(differences: list[int]) -> None:
    """Swapping the pairs keeps W and p, negates the rank-biserial and reverses the direction."""
    x, y = np.array(differences, dtype=np.float64), np.zeros(len(differences))
    there, back = signed_rank(x, y), signed_rank(y, x)
    assert (there.w, there.p) == (back.w, back.p)
    assert there.rank_biserial == -back.rank_biserial
    assert signed_rank(x, y, alternative="greater").p == signed_rank(y, x, alternative="less").p


def test_without_ties_p_is_that_of_scipy() -> None:
    """Without ties the signed-rank p equals scipy's, two-sided and one-sided."""
    rng = np.random.default_rng(8)
    x, y = rng.normal(0.4, 1.0, 12), rng.normal(size=12)
    for alternative in ("two-sided", "greater", "less"):
        ours = signed_rank(x, y, alternative=alternative)
        theirs = stats.wilcoxon(x, y, alternative=alternative, method="exact")
        assert ours.p == pytest.approx(theirs.pvalue, rel=1e-9)


def test_the_normal_approximation_is_that_of_scipy_and_is_met() -> None:
    """The normal approximation is scipy's, within .01 of the exact p at 50 pairs.

    Beyond 50 pairs the p of the approximation is reported.
    """
    rng = np.random.default_rng(2)
    x, y = rng.integers(1, 8, size=(2, 80)).astype(np.float64)
    fifty = signed_rank(x[:50], y[:50])
    assert fifty.method == "exact"
    assert abs(fifty.p - fifty.p_asymptotic) < 0.01
    eighty = signed_rank(x, y, exact_up_to=50)
    assert eighty.method == "asymptotic"
    theirs = stats.wilcoxon(x, y, method="approx", correction=False)
    assert eighty.p == pytest.approx(theirs.pvalue, rel=1e-9)


def test_equal_differences_of_decimals_tie() -> None:
    """The differences 0.3 - 0.2 and 0.2 - 0.1 tie, whatever their last bit."""
    decimal = signed_rank([0.3, 0.2, 0.5, 0.1], [0.2, 0.1, 0.1, 0.2])
    whole = signed_rank([3.0, 2.0, 5.0, 1.0], [2.0, 1.0, 1.0, 2.0])
    assert (decimal.w, decimal.p) == (whole.w, whole.p)


def test_missing_pairs_are_left_out_and_counted() -> None:
    """Pairs with a missing value are left out and counted."""
    nan = math.nan
    test = signed_rank([1.0, nan, 3.0, 4.0, 5.0], [0.0, 1.0, 1.0, nan, 1.0])
    assert (test.n, test.n_left_out, test.p) == (3, 2, 0.25)


def test_equal_pairs_give_a_p_of_one() -> None:
    """If all pairs are equal, the signed-rank p is 1, the effect is 0 and the zeros are counted."""
    test = signed_rank([1.0, 2.0, 3.0], [1.0, 2.0, 3.0])
    assert (test.p, test.p_asymptotic, test.rank_biserial, test.n_zero) == (1.0, 1.0, 0.0, 3)


def test_unusable_pairs_are_rejected() -> None:
    """Unequal lengths, no complete pairs, infinities and unknown options are rejected."""
    with pytest.raises(StatisticsError, match="pair up"):
        signed_rank([1.0, 2.0], [1.0])
    with pytest.raises(TooFewData, match="None of 2 pairs"):
        signed_rank([1.0, math.nan], [math.nan, 1.0])
    with pytest.raises(StatisticsError, match="infinite"):
        signed_rank([math.inf, 1.0], [1.0, 2.0])
    with pytest.raises(StatisticsError, match="two-sided, greater, less"):
        signed_rank([1.0], [2.0], alternative="bigger")  # type: ignore[arg-type]  # no such word


@_DRAWN
@given(_P_VALUES)
def test_adjusted_p_values_keep_their_order(p_values: list[float]) -> None:
    """Adjusted p values keep their order, are at least p and at most Bonferroni's or 1."""
    adjusted = holm(p_values)
    for p, after in zip(p_values, adjusted, strict=True):
        assert p <= after <= min(1.0, p * len(p_values) + 1e-15)
    ordered = [after for _, after in sorted(zip(p_values, adjusted, strict=True))]
    assert ordered == sorted(ordered)


def test_holm_by_hand() -> None:
    """Holm's p of .01, .04, .03 are .03, .06, .06; missing tests do not count."""
    assert holm([0.01, 0.04, 0.03]) == pytest.approx((0.03, 0.06, 0.06))
    adjusted = holm([0.01, math.nan, 0.03])
    assert adjusted[0] == pytest.approx(0.02)
    assert math.isnan(adjusted[1])
    with pytest.raises(StatisticsError, match="between 0 and 1"):
        holm([1.2])


def test_a_pairwise_comparison_uses_all_complete_pairs() -> None:
    """A subject without the third level still counts in the comparison of the first two."""
    values = [[1.0, 2.0, 3.0], [2.0, 4.0, 6.0], [1.0, 3.0, math.nan]]
    first, second, third = pairwise(values, ["0", "125", "350"])
    assert [(one.a, one.b) for one in (first, second, third)] == [
        ("0", "125"),
        ("0", "350"),
        ("125", "350"),
    ]
    assert (first.test.n, second.test.n, third.test.n) == (3, 2, 2)
    assert second.test.n_left_out == 1
    assert first.median_difference == -2.0
    with pytest.raises(TooFewData, match="'0' and '350'"):
        pairwise([[1.0, 1.0, math.nan]], ["0", "125", "350"])
