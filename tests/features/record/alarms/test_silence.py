"""Tests of a headset that sends nothing although its socket is open."""

import pytest

from app.features.record.alarms.alarm import WatchLimits
from app.wire import GOALS, GoalsReport
from tests.features.record.alarms.watched import TREMBLING, Watched, at, order, state

SECOND = TREMBLING.part(slice(0, 90))


def running(time_scale: float = 1.0) -> Watched:
    """Return a watch of a session with a running phase."""
    watched = Watched(time_scale)
    watched.watch.update_state(state(phase=order()), at(0.0))
    return watched


def lost_at(watched: Watched) -> list[float]:
    """Return the times at which the watch declared the running phase lost."""
    return [now_s for now_s, result in watched.checks if result.phase_is_lost]


def test_silence_stops_the_phase_once_after_three_seconds() -> None:
    """After three seconds of silence an alarm is raised and the phase is declared lost once."""
    watched = running()
    ended_s = watched.play(SECOND)
    watched.wait(ended_s, 3.5)
    assert watched.reported == [("silent", "raised")]
    assert lost_at(watched) == [pytest.approx(ended_s + 3.0, abs=0.5)]
    watched.watch.update_state(state(phase=order(status="paused")), at(ended_s + 3.5))
    watched.wait(ended_s + 3.5, 60.0)
    assert len(lost_at(watched)) == 1
    assert watched.watch.open[0].condition.value == pytest.approx(63.5, abs=0.6)


def test_a_phase_that_was_resumed_without_frames_is_stopped_again() -> None:
    """A phase that is resumed while no frames arrive is declared lost a second time."""
    watched = running()
    ended_s = watched.wait(watched.play(SECOND), 5.0)
    watched.watch.update_state(state(phase=order(status="paused")), at(ended_s))
    watched.watch.update_state(state(phase=order(status="running")), at(ended_s + 1.0))
    watched.wait(ended_s + 1.0, 1.0)
    assert len(lost_at(watched)) == 2
    assert watched.reported == [("silent", "raised")]


def test_the_silence_alarm_is_cleared_when_frames_arrive() -> None:
    """The alarm of a silent headset is cleared when its frames arrive again."""
    watched = running()
    silent_s = watched.wait(watched.play(SECOND), 10.0)
    watched.play(TREMBLING.part(slice(90, 540)), begin_s=silent_s)
    assert ("silent", "cleared") in watched.reported


def test_silence_raises_no_alarm_while_nothing_is_recorded() -> None:
    """A silent headset raises no alarm while the session is not recording."""
    watched = Watched()
    watched.watch.update_state(state(recording=False), at(0.0))
    watched.wait(0.0, 10.0)
    assert watched.reported == []
    watched.watch.update_state(state(), at(10.0))
    watched.wait(10.0, 2.5)
    assert watched.reported == []
    watched.wait(12.5, 1.0)
    assert watched.reported == [("silent", "raised")]


def test_a_delayed_check_does_not_count_as_silence() -> None:
    """A check that comes far too late, as after a suspension, restarts the measured silence."""
    watched = running()
    ended_s = watched.play(SECOND)
    watched.check(ended_s + 60.0)
    watched.wait(ended_s + 60.0, 2.5)
    assert watched.reported == []
    assert lost_at(watched) == []
    watched.wait(ended_s + 62.5, 1.0)
    assert ("silent", "raised") in watched.reported


def test_no_silence_is_reported_while_the_server_does_not_read() -> None:
    """While the server has stopped reading the socket, no silence is reported."""
    watched = running()
    ended_s = watched.play(SECOND)
    for turn in range(1, 20):
        watched.check(ended_s + 0.5 * turn, reading=False)
    assert lost_at(watched) == []
    assert "silent" not in {code for code, _ in watched.reported}


def test_frames_on_another_socket_of_the_session_count() -> None:
    """Frames on another socket of the same session prevent the alarm about silence."""
    watched = running()
    for turn in range(1, 30):
        watched.watch.silence.frame_arrived(at(0.5 * turn).monotonic_s)
        watched.check(0.5 * turn)
    assert watched.reported == []


@pytest.mark.parametrize(("time_scale", "limit_s"), [(1.0, 3.0), (20.0, 30.0), (100.0, 30.0)])
def test_an_accelerated_client_may_be_silent_for_longer(time_scale: float, limit_s: float) -> None:
    """A client that runs faster than real time is reported as silent only after 30 seconds."""
    watched = running(time_scale=time_scale)
    watched.wait(0.0, limit_s - 0.5)
    assert watched.reported == [("clock_unknown", "raised")] * (limit_s > 16.0)
    watched.wait(limit_s - 0.5, 0.5)
    assert watched.reported[-1] == ("silent", "raised")


def test_the_silence_limit_can_be_set() -> None:
    """The limit after which a headset counts as silent can be set."""
    watched = Watched(limits=WatchLimits(silent_s=0.2, check_every_s=0.05))
    watched.wait(0.0, 0.25)
    assert watched.reported == [("silent", "raised")]


def test_a_silent_headset_has_a_frame_rate_of_zero() -> None:
    """A headset that has stopped sending has a frame rate of zero, and none while not recording."""
    watched = running()
    assert watched.watch.signal(at(0.0))["frame_rate_hz"] == 0.0
    ended_s = watched.play(TREMBLING.part(slice(0, 450)))
    assert watched.watch.signal(at(ended_s))["frame_rate_hz"] == pytest.approx(90.0, abs=0.5)
    assert watched.watch.signal(at(ended_s + 2.5))["frame_rate_hz"] == 0.0
    watched.watch.update_state(state(recording=False), at(ended_s + 3.0))
    assert watched.watch.signal(at(ended_s + 3.0))["frame_rate_hz"] is None


@pytest.mark.parametrize(
    ("source", "code"), [("desktop", "page_silent"), ("script", "page_silent"), ("hands", "silent")]
)
def test_the_alarm_of_silence_names_what_is_silent(source: str, code: str) -> None:
    """A page on a screen that sends nothing is not called a headset to be woken."""
    watched = running()
    states = dict.fromkeys(GOALS, "tracked")
    watched.watch.feet.goals = GoalsReport.model_validate(
        {"t_s": 0.0, "frame_seq": 0, "source": source, "states": states}
    )
    watched.wait(watched.play(SECOND), 3.5)
    assert watched.reported == [(code, "raised")]
