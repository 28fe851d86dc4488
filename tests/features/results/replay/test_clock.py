"""The times of a phase: laws of its clock, whatever paused it or cut it off."""

from datetime import UTC, datetime, timedelta

import pytest

from app.features.results.replay.clock import ClockReport, PhaseClock, Run, Wall, stretches

NOON = datetime(2026, 3, 2, 12, 0, tzinfo=UTC)


def told(*said: tuple[int, str, float, float]) -> list[ClockReport]:
    """Reports as (run, what, client's time, active time)."""
    return [ClockReport(*one, cause="operator") for one in said]


def clock(*said: tuple[int, str, float, float], offsets_s: dict[int, float]) -> PhaseClock:
    """The clock of a phase of one minute."""
    return PhaseClock(offsets_s, (), stretches(told(*said), offsets_s, 60.0), 1.0)


def test_a_pause_stops_the_active_time_and_not_the_phases() -> None:
    """A pause of 5 s after 10 s: what is counted at 12 s happened at 17 s."""
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


def test_a_run_that_ends_without_a_word_stops_where_the_next_one_goes_on() -> None:
    """A headset that dies at 20 s of active time is followed by one with a clock of its own."""
    lost = clock(
        (1, "started", 100.0, 0.0),
        (2, "resumed", 7.0, 20.0),
        (2, "time_up", 47.0, 60.0),
        offsets_s={1: -100.0, 2: 43.0},
    )
    assert [(one.begin_s, one.end_s) for one in lost.active] == [(0.0, 20.0), (50.0, 90.0)]


def test_the_way_back_is_no_active_time() -> None:
    """Both of its ends are told; a pause in it changes nothing."""
    walked = clock(
        *((1, "started", 0.0, 0.0), (1, "walk_back_started", 8.0, 8.0), (1, "paused", 9.0, 8.0)),
        *((1, "walk_back_ended", 14.0, 8.0), (1, "time_up", 66.0, 60.0)),
        offsets_s={1: 0.0},
    )
    assert [(one.begin_s, one.end_s) for one in walked.active] == [(0.0, 8.0), (14.0, 66.0)]


def test_the_hour_of_a_faster_clock_is_counted_in_its_seconds() -> None:
    """At 20 seconds of the headset a second of the server, half a second later is ten."""
    run = Run(1, 0.0, 60.0, NOON, 1.0)
    fast = PhaseClock({1: 0.0}, (run,), (), 20.0)
    assert fast.of_utc(NOON + timedelta(seconds=0.5)) == pytest.approx(10.0)
    assert PhaseClock({}, (), (), 1.0).of_utc(NOON) is None


def test_nothing_began_after_the_server_had_heard_of_it() -> None:
    """An uneven clock is placed 220 ms too late and calls it 2 ms: the 222 ms are told."""
    heard = NOON - timedelta(milliseconds=220)
    assert Wall(NOON, 2.0).no_later_than(heard) == Wall(heard, 222.0)
    within = Wall(NOON, 2.0)
    assert within.no_later_than(NOON - timedelta(milliseconds=1)) is within
    assert Wall(None).no_later_than(heard) == Wall(None)


def test_a_wall_clock_that_was_set_moves_nothing() -> None:
    """A server's clock that was put back an hour says nothing of the headset's."""
    placed = Wall(NOON, 2.0)
    assert placed.no_later_than(NOON - timedelta(hours=1)) is placed
