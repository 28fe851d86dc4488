"""Tests of the active clock, which is stopped during pauses."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.science.tasks import ActiveClock, ClockError


@given(st.lists(st.integers(0, 100), min_size=1, max_size=20))
def test_active_time_is_the_sum_of_the_running_spans(quarters: list[int]) -> None:
    """Active time is the sum of the spans between resuming and pausing."""
    times_s = [sum(quarters[: index + 1]) / 4 for index in range(len(quarters))]
    clock, expected_s = ActiveClock().begin(times_s[0]), 0.0
    for index, (before_s, now_s) in enumerate(pairwise(times_s)):
        expected_s += now_s - before_s if index % 2 == 0 else 0.0
        assert clock.active_s(now_s) == expected_s
        clock = clock.pause(now_s) if index % 2 == 0 else clock.resume(now_s)


def test_a_clock_knows_when_a_phase_is_over() -> None:
    """A phase of 60 s of active time with a pause of 5 s ends 65 s after the start."""
    clock = ActiveClock().begin(10.0).pause(20.0)
    assert clock.reaches_s(60.0) is None
    assert clock.resume(25.0).reaches_s(60.0) == 75.0


def test_an_unbegun_clock_shows_zero() -> None:
    """Before the clock is started, active time is zero."""
    assert ActiveClock().active_s(5.0) == 0.0


def test_time_must_not_go_back() -> None:
    """A time before the previous one raises an error that states both times."""
    clock = ActiveClock().begin(2.0)
    with pytest.raises(ClockError, match=r"back from 2.0 s to 1.0 s"):
        clock.active_s(1.0)
    with pytest.raises(ClockError, match=r"back from 2.0 s to 1.0 s"):
        clock.pause(1.0)
    with pytest.raises(ClockError, match=r"back from 3.0 s to 1.0 s"):
        clock.pause(3.0).resume(1.0)
    with pytest.raises(ClockError, match="The time is nan"):
        clock.active_s(float("nan"))


def test_calls_out_of_order_are_rejected() -> None:
    """A clock can be started once, paused only while running and resumed only while paused."""
    clock = ActiveClock()
    with pytest.raises(ClockError, match="Begin it before resuming"):
        clock.resume(0.0)
    with pytest.raises(ClockError, match="Resume it before pausing"):
        clock.pause(0.0)
    with pytest.raises(ClockError, match="Resume it instead"):
        clock.begin(0.0).begin(1.0)
    with pytest.raises(ClockError, match="Pause it before resuming"):
        clock.begin(0.0).resume(1.0)
