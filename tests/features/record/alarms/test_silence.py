"""A headset that says nothing though its socket is open."""

import pytest

from app.features.record.alarms.alarm import WatchLimits
from tests.features.record.alarms.watched import TREMBLING, Watched, at, order, state

SECOND = TREMBLING.part(slice(0, 90))


def running(time_scale: float = 1.0) -> Watched:
    """A watch while a phase's clock runs."""
    watched = Watched(time_scale)
    watched.watch.update_state(state(phase=order()), at(0.0))
    return watched


def lost_at(watched: Watched) -> list[float]:
    """When a running phase was given up."""
    return [now_s for now_s, result in watched.checks if result.phase_is_lost]


def test_silence_is_noticed_after_three_seconds_and_stops_the_phase_once() -> None:
    """Within a look of the limit, and again only if the phase runs on without frames."""
    watched = running()
    ended_s = watched.play(SECOND)
    watched.wait(ended_s, 3.5)
    assert watched.told == [("silent", "raised")]
    assert lost_at(watched) == [pytest.approx(ended_s + 3.0, abs=0.5)]
    watched.watch.update_state(state(phase=order(status="paused")), at(ended_s + 3.5))
    watched.wait(ended_s + 3.5, 60.0)
    assert len(lost_at(watched)) == 1
    assert watched.watch.open[0].condition.value == pytest.approx(63.5, abs=0.6)


def test_a_phase_that_was_resumed_without_frames_is_stopped_again() -> None:
    """The alarm never cleared, and the phase still must not run unseen."""
    watched = running()
    ended_s = watched.wait(watched.play(SECOND), 5.0)
    watched.watch.update_state(state(phase=order(status="paused")), at(ended_s))
    watched.watch.update_state(state(phase=order(status="running")), at(ended_s + 1.0))
    watched.wait(ended_s + 1.0, 1.0)
    assert len(lost_at(watched)) == 2
    assert watched.told == [("silent", "raised")]


def test_silence_is_over_when_frames_flow() -> None:
    """Cleared three seconds after the first frame."""
    watched = running()
    silent_s = watched.wait(watched.play(SECOND), 10.0)
    watched.play(TREMBLING.part(slice(90, 540)), begin_s=silent_s)
    assert ("silent", "cleared") in watched.told


def test_nothing_is_expected_while_nothing_is_recorded() -> None:
    """Before the avatar appears and after the debriefing a headset may be quiet."""
    watched = Watched()
    watched.watch.update_state(state(recording=False), at(0.0))
    watched.wait(0.0, 10.0)
    assert watched.told == []
    watched.watch.update_state(state(), at(10.0))
    watched.wait(10.0, 2.5)
    assert watched.told == []
    watched.wait(12.5, 1.0)
    assert watched.told == [("silent", "raised")]


def test_a_server_that_slept_blames_nobody() -> None:
    """A look that comes much too late starts the waiting anew."""
    watched = running()
    ended_s = watched.play(SECOND)
    watched.check(ended_s + 60.0)
    watched.wait(ended_s + 60.0, 2.5)
    assert watched.told == []
    assert lost_at(watched) == []
    watched.wait(ended_s + 62.5, 1.0)
    assert ("silent", "raised") in watched.told


def test_a_server_that_has_stopped_reading_blames_nobody() -> None:
    """While too many messages wait for the disk the headset cannot be heard."""
    watched = running()
    ended_s = watched.play(SECOND)
    for turn in range(1, 20):
        watched.check(ended_s + 0.5 * turn, reading=False)
    assert lost_at(watched) == []
    assert "silent" not in {code for code, _ in watched.told}


def test_frames_on_another_socket_of_the_session_count() -> None:
    """A new headset streams while the old one's socket hangs half open."""
    watched = running()
    for turn in range(1, 30):
        watched.watch.silence.frame_arrived(at(0.5 * turn).monotonic_s)
        watched.check(0.5 * turn)
    assert watched.told == []


@pytest.mark.parametrize(("time_scale", "limit_s"), [(1.0, 3.0), (20.0, 30.0), (100.0, 30.0)])
def test_a_client_faster_than_life_may_wait_longer(time_scale: float, limit_s: float) -> None:
    """It waits for the server, and owes nobody a steady stream."""
    watched = running(time_scale=time_scale)
    watched.wait(0.0, limit_s - 0.5)
    assert watched.told == [("clock_unknown", "raised")] * (limit_s > 16.0)
    watched.wait(limit_s - 0.5, 0.5)
    assert watched.told[-1] == ("silent", "raised")


def test_the_limit_is_an_argument() -> None:
    """Tests need not wait for three seconds."""
    watched = Watched(limits=WatchLimits(silent_s=0.2, check_every_s=0.05))
    watched.wait(0.0, 0.25)
    assert watched.told == [("silent", "raised")]


def test_a_headset_that_has_ceased_to_send_has_no_frame_rate() -> None:
    """The figure of before would be a lie; where nothing is wanted, there is none to tell."""
    watched = running()
    assert watched.watch.signal(at(0.0))["frame_rate_hz"] == 0.0
    ended_s = watched.play(TREMBLING.part(slice(0, 450)))
    assert watched.watch.signal(at(ended_s))["frame_rate_hz"] == pytest.approx(90.0, abs=0.5)
    assert watched.watch.signal(at(ended_s + 2.5))["frame_rate_hz"] == 0.0
    watched.watch.update_state(state(recording=False), at(ended_s + 3.0))
    assert watched.watch.signal(at(ended_s + 3.0))["frame_rate_hz"] is None
