"""Tests of a timed phase on the headset's clock: its reports and its active time."""

import pytest

from app.rehearsal.timed_run import FreeRun
from app.wire.messages import PhaseReport
from tests.rehearsal.orders import FRAME_S, Timeline, order


def test_a_phase_prepares_runs_its_time_freezes_and_ends() -> None:
    """A phase reports start, time up and end, after preparation, duration and freeze."""
    line = Timeline(FreeRun(order(), 0.0))
    line.draw(2.0)
    assert line.words == ["started", "time_up", "ended"]
    started, time_up, ended = line.told
    assert isinstance(started, PhaseReport)
    assert isinstance(time_up, PhaseReport)
    assert isinstance(ended, PhaseReport)
    assert started.t_s == pytest.approx(0.5, abs=FRAME_S)
    assert time_up.t_s == started.t_s + 1.0
    assert time_up.active_s == pytest.approx(1.0)
    assert ended.t_s == pytest.approx(time_up.t_s + 0.2, abs=FRAME_S)
    assert line.run.ended


def test_active_time_never_exceeds_the_duration() -> None:
    """Active time never exceeds the duration, however late the last frame is drawn."""
    line = Timeline(FreeRun(order(), 0.0))
    line.draw(1.0)
    assert line.run.active_s(1000.0) == 1.0


def test_an_operators_pause_stops_the_clock_until_the_resume() -> None:
    """An operator's pause stops the clock until the resume, and both are reported."""
    line = Timeline(FreeRun(order(), 0.0))
    line.draw(1.0)
    line.follow(order(status="running", pausing=True))
    before_s = line.run.active_s(line.t_s)
    line.draw(5.0)
    line.follow(order(status="paused", resuming=True, active_s=before_s))
    assert line.run.active_s(line.t_s) == before_s
    line.draw(2.0)
    assert line.words == ["started", "paused", "resumed", "time_up", "ended"]


def test_a_broken_connection_stops_the_clock_and_the_preparation() -> None:
    """A broken connection stops the clock and the preparation on the headset too.

    So both sides count the same time.
    """
    line = Timeline(FreeRun(order(), 0.0))
    line.draw(3.0, connected=False)
    assert line.words == []
    line.draw(0.5)
    line.draw(3.0, connected=False)
    assert line.words == ["started", "paused"]
    assert line.run.active_s(line.t_s) == pytest.approx(0.5, abs=2 * FRAME_S)


def test_a_loss_that_only_the_server_noticed_pauses_the_headset() -> None:
    """After a loss that only the server noticed, the headset reports the pause and the resume."""
    line = Timeline(FreeRun(order(), 0.0))
    line.draw(1.0)
    line.follow(order(status="paused", active_s=0.4))
    line.follow(order(status="paused", active_s=0.5, resuming=True))
    assert line.words == ["started", "paused", "resumed"]


def test_a_resume_with_the_pause_gives_both_reports() -> None:
    """A resume that arrives with the pause gives both reports immediately and only once.

    Otherwise the server would wait for a resume that the headset would never send.
    """
    line = Timeline(FreeRun(order(), 0.0))
    line.draw(1.0)
    line.follow(order(status="paused", active_s=0.4, resuming=True))
    assert line.words == ["started", "paused", "resumed"]
    line.follow(order(status="running", active_s=0.5))
    assert line.words == ["started", "paused", "resumed"]


@pytest.mark.parametrize(
    ("status", "words"),
    [("running", ["paused"]), ("walk_back", ["walk_back_ended", "paused"]), ("paused", [])],
)
def test_a_client_that_takes_over_waits_for_the_resume(status: str, words: list[str]) -> None:
    """A client that takes over waits for the resume, then uses only the remaining active time."""
    line = Timeline(FreeRun(order(status=status, active_s=0.75), 0.0))
    line.draw(1.0)
    if status != "paused":
        line.follow(order(status="running", active_s=0.75))
    assert line.words == words
    assert line.run.active_s(line.t_s) == 0.75
    line.follow(order(status="paused", active_s=0.75, resuming=True))
    resumed_s = line.t_s
    line.draw(1.0)
    assert line.words == [*words, "resumed", "time_up", "ended"]
    time_up = line.told[-2]
    assert isinstance(time_up, PhaseReport)
    assert time_up.t_s - resumed_s == pytest.approx(0.25)


def test_a_client_that_takes_over_in_the_freeze_only_ends_the_phase() -> None:
    """A client that takes over during the freeze only reports the end of the phase."""
    line = Timeline(FreeRun(order(status="freezing", active_s=1.0), 0.0))
    line.draw(0.5)
    assert line.words == ["ended"]


def test_a_client_that_takes_over_gets_the_used_active_time() -> None:
    """A client that takes over gets the other run's active time, even if it is updated later."""
    line = Timeline(FreeRun(order(status="running", active_s=0.25), 0.0))
    line.draw(0.1)
    line.follow(order(status="running", active_s=0.5))
    line.follow(order(status="paused", active_s=0.75, resuming=True))
    assert line.words == ["paused", "resumed"]
    assert line.run.active_s(line.t_s) == 0.75
