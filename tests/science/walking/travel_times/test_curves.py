"""Tests of the curves of travel time: they are the agents' own, and cut walks have no ramp."""

import numpy as np
import pytest

from app.science.rotations import FloatArray
from app.science.walking.following import SteeringFollower
from app.science.walking.records import Course, WalkingError
from app.science.walking.synthetic import straight_path
from app.science.walking.travel_times import StartingAndStopping, TimedWalks


def walks(lengths: FloatArray, *, resting: float = 1.0, turning: float = 0.0) -> TimedWalks:
    """Return walks of these lengths, with durations that do not matter."""
    count = len(lengths)
    return TimedWalks(
        lengths,
        np.full(count, turning),
        np.full(count, resting),
        np.empty((count, 0)),
        np.ones(count),
        ("1",) * count,
    )


@pytest.mark.parametrize(("speed", "rate"), [(1.3, 0.8), (1.6, 1.9), (0.5, 0.3)])
def test_the_curve_is_the_time_of_an_agent(speed: float, rate: float) -> None:
    """From rest to rest the curve is an agent's time, on paths shorter and longer than its ramp."""
    lengths = np.array([0.4, 0.9, 1.7, 3.0, 7.0])
    values = np.array([np.log(1.0 / speed), np.log(speed / rate), 0.0, 1.0])
    times_s = StartingAndStopping().times_s(walks(lengths), values)
    follower = SteeringFollower()
    for length, expected_s in zip(lengths, times_s, strict=True):
        course = Course(straight_path(length), 1, 60.0)
        arrival_s = follower.follow(course, np.array([[speed, rate, 2.0]])).arrival_s[0]
        # The agent arrives 5 cm early, where it is slow.
        early_s = np.sqrt(2.0 * follower.rules.radius_m / rate)
        assert expected_s - early_s - 0.1 < arrival_s < expected_s + 0.02


def test_a_walk_that_is_cut_off_lacks_its_ramp() -> None:
    """Without rest at either end only distance over speed is left; with one, half the ramp."""
    lengths, values = np.array([5.0, 12.0]), np.array([np.log(0.8), np.log(1.6), 0.0, 1.0])
    cut, half, whole = (
        StartingAndStopping().times_s(walks(lengths, resting=share), values)
        for share in (0.0, 0.5, 1.0)
    )
    np.testing.assert_allclose(cut, 0.8 * lengths)
    np.testing.assert_allclose(half - cut, 0.8)
    np.testing.assert_allclose(whole - cut, 1.6)


def test_the_curve_is_smooth_where_full_speed_is_just_reached() -> None:
    """Time and pace do not jump at the length from which an agent reaches its full speed."""
    values = np.array([np.log(0.8), np.log(1.6), 0.0, 1.0])
    knee = 1.6 / 0.8
    lengths = knee + 1e-4 * np.array([-2.0, -1.0, 1.0, 2.0])
    times_s = StartingAndStopping().times_s(walks(lengths), values)
    np.testing.assert_allclose(np.diff(times_s) / np.diff(lengths), 0.8, rtol=1e-3)
    assert np.all(np.diff(times_s) > 0.0)


@pytest.mark.parametrize(("column", "value"), [("durations_s", 0.0), ("lengths_m", np.nan)])
def test_times_and_lengths_must_be_positive(column: str, value: float) -> None:
    """A walk of no time or no length is refused with its number and its person."""
    columns = {"lengths_m": np.ones(2), "durations_s": np.ones(2)}
    columns[column][1] = value
    with pytest.raises(WalkingError, match=r"Walk 2 of 'b' has a"):
        TimedWalks(
            columns["lengths_m"], np.zeros(2), np.ones(2), np.empty((2, 0)),
            columns["durations_s"], ("a", "b"),
        )  # fmt: skip
