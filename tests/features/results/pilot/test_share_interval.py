"""Tests of the intervals of completions, as shares of those at the lowest latency."""

import numpy as np
import pytest

from app.features.results.pilot.simulation.report import _share_interval


def test_the_interval_is_students_of_the_mean() -> None:
    """Of 1 to 5 with mean 3, t(4) of 95 % is 2.776 and the standard error 0.7071."""
    tasks = np.array([1.0, 2.0, 3.0, 4.0, 5.0])
    assert _share_interval(tasks, 6.0) == pytest.approx(
        ((3.0 - 2.7764 * 0.70711) / 6.0, (3.0 + 2.7764 * 0.70711) / 6.0), abs=1e-4
    )


def test_nobody_completes_less_than_nothing() -> None:
    """The interval ends at 0, and is one point if all are alike."""
    low, high = _share_interval(np.array([0.0, 0.0, 1.0]), 2.0)
    assert low == 0.0
    assert high is not None
    assert high > 0.5
    assert _share_interval(np.array([2.0, 2.0]), 4.0) == (0.5, 0.5)


def test_one_person_has_no_interval() -> None:
    """One value tells nothing of the spread, and nothing is a share of none."""
    assert _share_interval(np.array([2.0]), 4.0) == (None, None)
    assert _share_interval(np.array([0.0, 0.0]), 0.0) == (None, None)
