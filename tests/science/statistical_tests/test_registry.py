"""What every test of the registry gives, whichever it is."""

import numpy as np
import pytest

from app.science.statistical_tests import TESTS, Sample, StatisticalTest, statistical_test

RISING = np.array([[1.0, 2.0, 4.0], [2.0, 3.0, 3.5], [0.5, 2.5, 5.0], [1.0, 2.0, 3.0]])


@pytest.mark.parametrize("test", TESTS, ids=lambda one: one.key)
def test_every_test_reports_what_papers_print(test: StatisticalTest) -> None:
    """A probability, everybody who was in it, and a table whose rows fit its titles."""
    found = test.load()(Sample(RISING, ("low", "middle", "high"), test.directions[0]))
    assert 0.0 < found.p <= 1.0
    assert found.n == len(RISING)
    assert f"n = {len(RISING)}" in found.sentence
    assert {len(row) for row in found.rows} == {len(found.columns)}


def test_no_two_tests_have_one_key() -> None:
    """A study file names a test by its key alone."""
    assert len({one.key for one in TESTS}) == len(TESTS)
    assert [statistical_test(one.key) for one in TESTS] == list(TESTS)


def test_page_follows_the_declared_direction() -> None:
    """Values that rise are likely under one declaration and unlikely under the other."""
    make = statistical_test("page_trend").load()
    rises = make(Sample(RISING, ("a", "b", "c"), "rises"))
    falls = make(Sample(RISING, ("a", "b", "c"), "falls"))
    assert rises.p < 0.05 < falls.p
