"""Active time, as the frames of a recording tell it."""

import numpy as np
import pytest

from app.science.joint_error.course import active_times
from app.science.rotations import FloatArray

STEP_S = 0.25


def _times(frames: int) -> FloatArray:
    return 100.0 + STEP_S * np.arange(frames, dtype=np.float64)


def test_a_clock_that_always_runs_counts_from_the_first_frame() -> None:
    """Whatever the clock of the recording shows then."""
    found = active_times(_times(8), np.ones(8, np.bool_))
    np.testing.assert_array_equal(found, STEP_S * np.arange(8))


def test_nothing_passes_while_the_clock_stands() -> None:
    """Four frames of a pause, and what comes after goes on where it was left."""
    active = np.array([1, 1, 0, 0, 0, 0, 1, 1], np.bool_)
    found = active_times(_times(8), active)
    np.testing.assert_array_equal(found, STEP_S * np.array([0, 1, 2, 2, 2, 2, 2, 3]))


def test_time_passes_where_frames_are_missing() -> None:
    """A gap of two seconds in which the clock ran is two seconds."""
    times_s = np.array([0.0, 1.0, 3.0, 4.0])
    np.testing.assert_array_equal(active_times(times_s, np.ones(4, np.bool_)), times_s)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 7.0])
def test_a_time_that_is_none_adds_nothing_and_is_made_up_for(bad: float) -> None:
    """Neither one that is not finite nor one that goes back; the next good one knows better."""
    times_s = _times(6)
    times_s[3] = bad
    found = active_times(times_s, np.ones(6, np.bool_))
    np.testing.assert_array_equal(found, STEP_S * np.array([0, 1, 2, 2, 4, 5]))


def test_no_time_at_all_is_no_time() -> None:
    """Without a usable time, before the first, and without frames."""
    one = np.ones(3, np.bool_)
    assert active_times(np.full(3, np.nan), one).tolist() == [0.0] * 3
    assert active_times(np.array([np.nan, 5.0, 6.0]), one).tolist() == [0.0, 0.0, 1.0]
    assert active_times(np.empty(0), np.empty(0, np.bool_)).tolist() == []
