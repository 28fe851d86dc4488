"""Tests of active time computed from the frames of a recording."""

import numpy as np
import pytest

from app.science.joint_error.course import active_times
from app.science.rotations import FloatArray

STEP_S = 0.25


def _times(frames: int) -> FloatArray:
    return 100.0 + STEP_S * np.arange(frames, dtype=np.float64)


def test_a_clock_that_always_runs_counts_from_the_first_frame() -> None:
    """If the clock always runs, active time counts from the first frame's time."""
    found = active_times(_times(8), np.ones(8, np.bool_))
    np.testing.assert_array_equal(found, STEP_S * np.arange(8))


def test_active_time_stands_still_during_a_pause() -> None:
    """Active time does not advance over four paused frames and continues after them."""
    active = np.array([1, 1, 0, 0, 0, 0, 1, 1], np.bool_)
    found = active_times(_times(8), active)
    np.testing.assert_array_equal(found, STEP_S * np.array([0, 1, 2, 2, 2, 2, 2, 3]))


def test_time_passes_where_frames_are_missing() -> None:
    """A gap of two seconds in which the clock ran counts as two seconds of active time."""
    times_s = np.array([0.0, 1.0, 3.0, 4.0])
    np.testing.assert_array_equal(active_times(times_s, np.ones(4, np.bool_)), times_s)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 7.0])
def test_an_invalid_time_adds_nothing_until_the_next_valid_one(bad: float) -> None:
    """A non-finite time or one that goes back adds nothing; the next valid one catches up."""
    times_s = _times(6)
    times_s[3] = bad
    found = active_times(times_s, np.ones(6, np.bool_))
    np.testing.assert_array_equal(found, STEP_S * np.array([0, 1, 2, 2, 4, 5]))


def test_without_valid_times_there_is_no_active_time() -> None:
    """Active time is zero without frames, without valid times, and before the first one."""
    one = np.ones(3, np.bool_)
    assert active_times(np.full(3, np.nan), one).tolist() == [0.0] * 3
    assert active_times(np.array([np.nan, 5.0, 6.0]), one).tolist() == [0.0, 0.0, 1.0]
    assert active_times(np.empty(0), np.empty(0, np.bool_)).tolist() == []
