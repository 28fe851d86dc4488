"""Tests of Page's trend test: enumeration, symmetry and limits."""

import math
from itertools import permutations, product

import numpy as np
import pytest
from scipy import stats

from app.science.statistics import ConstantData, friedman, page_trend
from app.science.statistics.arrays import row_midranks


def test_with_ties_p_is_that_of_every_arrangement() -> None:
    """With ties Page's p equals the enumeration of all arrangements of three subjects."""
    ranks = row_midranks(np.array([[1.0, 1.0, 2.0], [1.0, 2.0, 3.0], [2.0, 1.0, 2.0]]))
    test = page_trend(ranks)
    places = np.array([1.0, 2.0, 3.0])
    sums = [
        sum(np.dot(row, places) for row in rows)
        for rows in product(*(list(permutations(row)) for row in ranks.tolist()))
    ]
    expected = float(np.mean(np.array(sums) >= test.statistic - 1e-9))
    assert test.p_given_ties == pytest.approx(expected, abs=1e-12)
    falling = float(np.mean(np.array(sums) <= test.statistic + 1e-9))
    assert test.p_falling_given_ties == pytest.approx(falling, abs=1e-12)
    assert (test.p_rises, test.p_falls) == (test.p_given_ties, test.p_falling_given_ties)


@pytest.mark.parametrize(("n", "k"), [(5, 3), (12, 3), (4, 4), (3, 5)])
def test_without_ties_p_is_that_of_scipy(n: int, k: int) -> None:
    """Without ties both forms of Page's exact p equal scipy's."""
    blocks = np.random.default_rng(n * k).normal(size=(n, k)) + 0.3 * np.arange(k)
    test = page_trend(blocks)
    theirs = stats.page_trend_test(blocks, method="exact")
    assert test.statistic == theirs.statistic
    assert test.p == pytest.approx(theirs.pvalue, rel=1e-9)
    assert test.p_given_ties == pytest.approx(test.p, rel=1e-9)


def test_a_fall_is_a_rise_of_the_reversed_levels() -> None:
    """Page's p of a falling trend is that of a rising one with reversed levels."""
    blocks = np.random.default_rng(3).integers(1, 6, size=(9, 3)).astype(np.float64)
    assert page_trend(blocks).p_falling == pytest.approx(page_trend(blocks[:, ::-1]).p, abs=1e-12)


def test_many_subjects_come_to_the_normal_distribution() -> None:
    """Page's exact and normal p differ by less than .02 at 50 subjects.

    Beyond 50 subjects only the normal one is given.
    """
    blocks = np.random.default_rng(4).normal((0.0, 0.1, 0.2), size=(51, 3))
    fifty = page_trend(blocks[:50])
    assert fifty.method == "exact"
    assert abs(fifty.p - fifty.p_asymptotic) < 0.02
    more = page_trend(blocks)
    assert (more.method, more.p) == ("asymptotic", more.p_asymptotic)
    assert math.isnan(more.p_given_ties)


def test_equal_values_have_no_trend() -> None:
    """If everybody's values are equal, there is nothing to rank, as Friedman's test says, too."""
    equal = np.repeat([[1.0], [2.0], [3.0], [4.0]], 3, axis=1)
    for test in (page_trend, friedman):
        with pytest.raises(ConstantData, match=r"4 subjects .* nothing to rank"):
            test(equal)
    equal[0, 2] = 5.0
    assert page_trend(equal).p_given_ties == pytest.approx(1 / 3)
