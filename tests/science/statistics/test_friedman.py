"""Tests of Friedman's test: enumeration, invariances and limits."""

from itertools import permutations, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.science.statistics import ConstantData, StatisticsError, TooFewData, friedman
from app.science.statistics.arrays import FloatArray
from tests.science.statistics.published import WINE

_DRAWN = settings(max_examples=40, deadline=None)


@st.composite
def likert(draw: st.DrawFn, most_subjects: int = 8, most_levels: int = 4) -> FloatArray:
    """Draw answers 1 to 5 with many ties that are not all equal."""
    n = draw(st.integers(2, most_subjects))
    k = draw(st.integers(2, most_levels))
    row = st.lists(st.integers(1, 5), min_size=k, max_size=k)
    rows = draw(st.lists(row, min_size=n, max_size=n))
    if all(len(set(one)) == 1 for one in rows):
        rows[0][0] += 1
    return np.array(rows, dtype=np.float64)


def _by_brute_force(blocks: FloatArray) -> float:
    """Return the share of all arrangements whose statistic is at least as large."""
    seen = friedman(blocks, exact_up_to=0).statistic
    arrangements = [sorted(permutations(row)) for row in blocks.tolist()]
    found = [
        friedman(np.array(rows), exact_up_to=0).statistic >= seen - 1e-9
        for rows in product(*arrangements)
    ]
    return sum(found) / len(found)


@pytest.mark.parametrize(
    "blocks",
    [
        [[1.0, 2.0, 3.0], [1.0, 3.0, 2.0], [1.0, 2.0, 3.0]],
        [[1.0, 1.0, 2.0], [3.0, 2.0, 1.0], [1.0, 2.0, 2.0]],
        [[1.0, 2.0, 3.0, 4.0], [2.0, 2.0, 1.0, 1.0]],
        [[1.0, 2.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [1.0, 2.0]],
    ],
)
def test_the_exact_p_is_that_of_every_arrangement(blocks: list[list[float]]) -> None:
    """Friedman's exact p equals the enumeration of all arrangements, with and without ties."""
    test = friedman(blocks)
    assert test.method == "exact"
    assert test.p == pytest.approx(_by_brute_force(np.array(blocks)), abs=1e-12)


@_DRAWN
@given(likert())
def test_names_and_scales_do_not_matter(blocks: FloatArray) -> None:
    """Reordering subjects or levels and monotone transforms do not change Friedman's test."""
    rng = np.random.default_rng(blocks.size)
    moved = blocks[rng.permutation(blocks.shape[0])][:, rng.permutation(blocks.shape[1])]
    before = friedman(blocks)
    for other in (moved, np.exp(blocks), 3.0 * blocks - 7.0):
        after = friedman(other)
        assert after.statistic == pytest.approx(before.statistic, abs=1e-9)
        assert after.p == pytest.approx(before.p, abs=1e-12)


@_DRAWN
@given(likert())
def test_p_and_agreement_stay_in_bounds(blocks: FloatArray) -> None:
    """In Friedman's test W is 0 to 1, p at most 1, and mean ranks average (k + 1) / 2."""
    test = friedman(blocks)
    assert -1e-12 <= test.kendall_w <= 1.0 + 1e-12
    assert 0.0 < test.p <= 1.0
    assert np.mean(test.mean_ranks) == pytest.approx(0.5 * (blocks.shape[1] + 1))


def test_exact_and_asymptotic_meet_at_many_subjects() -> None:
    """Friedman's exact and asymptotic p differ by less than .01 at 60 subjects, by more at 6."""
    rng = np.random.default_rng(5)
    many = friedman(rng.normal((0.0, 0.1, 0.25), size=(60, 3)), exact_up_to=60)
    assert many.method == "exact"
    assert abs(many.p - many.p_asymptotic) < 0.01
    few = friedman([[1, 2, 3], [1, 3, 2], [1, 2, 3], [2, 1, 3], [1, 2, 3], [3, 2, 1]])
    assert abs(few.p - few.p_asymptotic) > 0.01


def test_full_agreement_has_the_smallest_p_there_is() -> None:
    """Twelve subjects in full agreement give W 1 and p 6 / 6^12 in Friedman's test."""
    test = friedman(np.tile([1.0, 2.0, 3.0], (12, 1)))
    assert test.kendall_w == pytest.approx(1.0)
    assert test.p == pytest.approx(6.0 / 6.0**12, rel=1e-9)


def test_too_many_arrangements_give_an_asymptotic_p() -> None:
    """With nine levels Friedman's p is asymptotic, and a note states the reason."""
    test = friedman(np.random.default_rng(1).normal(size=(5, 9)))
    assert test.method == "asymptotic"
    assert test.p == test.p_asymptotic
    assert "9 levels" in test.note


def test_data_that_cannot_be_tested_are_rejected() -> None:
    """Constant rows, one subject, one level and missing values raise an error with a remedy."""
    with pytest.raises(ConstantData, match="nothing to rank"):
        friedman([[1.0, 1.0], [2.0, 2.0]])
    with pytest.raises(TooFewData, match="1 complete subjects"):
        friedman(WINE[:1])
    with pytest.raises(TooFewData, match="1 levels"):
        friedman(WINE[:, :1])
    with pytest.raises(StatisticsError, match="missing"):
        friedman([[1.0, np.nan], [1.0, 2.0]])
