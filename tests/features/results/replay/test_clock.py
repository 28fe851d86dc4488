"""Tests of the time axis of a phase with pauses and interruptions."""

from datetime import UTC, datetime, timedelta

import pytest

from app.features.results.replay.clock import ClockReport, PhaseClock, Run, Wall, stretches

NOON = datetime(2026, 3, 2, 12, 0, tzinfo=UTC)


def reports_of(*reports: tuple[int, str, float, float]) -> list[ClockReport]:
    """Return reports given as (run, what, client's time, active time)."""
    return [ClockReport(*one, cause="operator") for one in reports]


def clock(*reports: tuple[int, str, float, float], offsets_s: dict[int, float]) -> PhaseClock:
    """Return the clock of a phase of one minute with these reports."""
    return PhaseClock(offsets_s, (), stretches(reports_of(*reports), offsets_s, 60.0), 1.0)


def test_a_pause_stops_active_time_but_not_the_phases_time() -> None:
    """A pause stops the active time but not the time of the phase."""
    paused = clock(
        *((1, "started", 100.0, 0.0), (1, "paused", 110.0, 10.0), (1, "resumed", 115.0, 10.0)),
        *((1, "time_up", 165.0, 60.0), (1, "ended", 168.0, 60.0)),
        offsets_s={1: -100.0},
    )
    assert [(one.begin_s, one.end_s) for one in paused.active] == [(0.0, 10.0), (15.0, 65.0)]
    assert paused.of_active(12.0, later=False) == pytest.approx(17.0)
    assert paused.of_active(10.0, later=False) == pytest.approx(10.0)
    assert paused.of_active(10.0, later=True) == pytest.approx(15.0)
    assert paused.of_active(60.0, later=True) == pytest.approx(65.0)
    assert paused.duration_s == pytest.approx(65.0)


def test_a_run_that_ends_abruptly_stops_where_the_next_continues() -> None:
    """A run that ends without a report stops at the active time at which the next continues."""
    lost = clock(
        (1, "started", 100.0, 0.0),
        (2, "resumed", 7.0, 20.0),
        (2, "time_up", 47.0, 60.0),
        offsets_s={1: -100.0, 2: 43.0},
    )
    assert [(one.begin_s, one.end_s) for one in lost.active] == [(0.0, 20.0), (50.0, 90.0)]


def test_a_walk_back_is_not_active_time() -> None:
    """A walk back is not active time, even with a pause in it."""
    walked = clock(
        *((1, "started", 0.0, 0.0), (1, "walk_back_started", 8.0, 8.0), (1, "paused", 9.0, 8.0)),
        *((1, "walk_back_ended", 14.0, 8.0), (1, "time_up", 66.0, 60.0)),
        offsets_s={1: 0.0},
    )
    assert [(one.begin_s, one.end_s) for one in walked.active] == [(0.0, 8.0), (14.0, 66.0)]


def test_utc_is_converted_with_the_time_scale() -> None:
    """At a time scale of 20 half a second of UTC is ten seconds of the phase."""
    run = Run(1, 0.0, 60.0, NOON, 1.0)
    fast = PhaseClock({1: 0.0}, (run,), (), 20.0)
    assert fast.of_utc(NOON + timedelta(seconds=0.5)) == pytest.approx(10.0)
    assert PhaseClock({}, (), (), 1.0).of_utc(NOON) is None


def test_no_event_is_placed_after_the_server_heard_of_it() -> None:
    """No event is placed after the server received it; a shift is added to its uncertainty."""
    heard = NOON - timedelta(milliseconds=220)
    assert Wall(NOON, 2.0).no_later_than(heard) == Wall(heard, 222.0)
    within = Wall(NOON, 2.0)
    assert within.no_later_than(NOON - timedelta(milliseconds=1)) is within
    assert Wall(None).no_later_than(heard) == Wall(None)


def test_a_wall_clock_set_back_moves_no_event() -> None:
    """A server's wall clock that was set back by an hour moves no event."""
    placed = Wall(NOON, 2.0)
    assert placed.no_later_than(NOON - timedelta(hours=1)) is placed
