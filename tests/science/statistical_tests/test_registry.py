"""Tests of the properties of every test in the registry of statistical tests."""

import numpy as np
import pytest

from app.science.statistical_tests import TESTS, Sample, StatisticalTest, statistical_test
from app.science.statistics import ConstantData

RISING = np.array([[1.0, 2.0, 4.0], [2.0, 3.0, 3.5], [0.5, 2.5, 5.0], [1.0, 2.0, 3.0]])


@pytest.mark.parametrize("test", TESTS, ids=lambda one: one.key)
def test_every_test_reports_what_papers_print(test: StatisticalTest) -> None:
    """Every test reports a p value, its number of participants and a complete table."""
    found = test.load()(Sample(RISING, ("low", "middle", "high"), test.directions[0]))
    assert 0.0 < found.p <= 1.0
    assert found.n == len(RISING)
    assert f"n = {len(RISING)}" in found.sentence
    assert {len(row) for row in found.rows} == {len(found.columns)}


def test_every_test_has_a_key_of_its_own() -> None:
    """No two tests have the same key, by which study files name them."""
    assert len({one.key for one in TESTS}) == len(TESTS)
    assert [statistical_test(one.key) for one in TESTS] == list(TESTS)


def test_page_follows_the_declared_direction() -> None:
    """Page's test gives a small p in the declared direction and a large one in the opposite."""
    make = statistical_test("page_trend").load()
    rises = make(Sample(RISING, ("a", "b", "c"), "rises"))
    falls = make(Sample(RISING, ("a", "b", "c"), "falls"))
    assert rises.p < 0.05 < falls.p


def test_declared_comparisons_that_say_nothing_have_no_p() -> None:
    """Comparisons of equal values are no result; one of several is counted and named as untested.

    The smallest p is that of a comparison that was made.
    """
    make = statistical_test("against_reference").load()
    equal = np.repeat(RISING[:, :1], 3, axis=1)
    for holm in (True, False):
        with pytest.raises(
            ConstantData, match=r"b – a was not tested: all .* differences are zero"
        ):
            make(Sample(equal, ("a", "b", "c"), "rises", holm=holm))
    equal[:, 2] = RISING[:, 2]
    found = make(Sample(equal, ("a", "b", "c"), "rises"))
    assert "of 2 comparisons with a (1 not tested)" in found.sentence
    assert found.rows[0][-3:] == ("–", "–", "–")
    assert found.rows[1][-1] == f"{found.p:.3f}"
    equal[:, 2] = equal[:, 0] - 1.0
    assert make(Sample(equal, ("a", "b", "c"), "rises")).p == 1.0


@pytest.mark.parametrize("key", ["friedman", "page_trend", "against_reference"])
def test_no_declared_rank_test_prints_a_p_of_equal_values(key: str) -> None:
    """Where everybody's values are equal, every declarable test on ranks says so and has no p."""
    test = statistical_test(key)
    with pytest.raises(ConstantData, match="nothing to"):
        test.load()(Sample(np.full((6, 3), 4.0), ("a", "b", "c"), test.directions[-1]))
