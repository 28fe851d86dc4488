"""Tests of the properties of every test in the registry of statistical tests."""

import numpy as np
import pytest

from app.science.statistical_tests import TESTS, Sample, StatisticalTest, statistical_test

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
