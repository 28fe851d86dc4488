"""Tests of the uncertainty of the headset's clock, and of data that are not on disk yet."""

import pytest

from app.wire.messages import Probed, Produced, StreamPosition
from tests.features.record.alarms.watched import TREMBLING, Watched, at, state, welcome


def reading(sent_s: float, trip_s: float, *, held_s: float = 0.001) -> Probed:
    """Return a probe with a round trip of `trip_s`, of which the server took `held_s`."""
    received_ns = int(5e9)
    return Probed(
        client_sent_s=sent_s,
        server_received_ns=received_ns,
        server_sent_ns=received_ns + int(held_s * 1e9),
        client_received_s=sent_s + trip_s,
    )


def unanswered(sent_s: float) -> Probed:
    """Return a probe that was not answered."""
    return Probed(
        client_sent_s=sent_s,
        server_received_ns=None,
        server_sent_ns=None,
        client_received_s=None,
    )


def quiet(time_scale: float = 1.0) -> Watched:
    """Return a watch of a session that is not recording."""
    watched = Watched(time_scale)
    watched.watch.update_state(state(recording=False), at(0.0))
    return watched


def test_the_uncertainty_is_half_of_the_smallest_round_trip_of_the_last_minute() -> None:
    """The clock's uncertainty is half the shortest round trip of the last minute.

    The time that the server took to answer is subtracted.
    """
    watched = quiet()
    assert watched.watch.signal(at(0.0))["clock_uncertainty_ms"] is None
    watched.watch.probed(reading(0.0, 0.005), at(0.0))
    watched.watch.probed(reading(1.0, 0.017), at(1.0))
    assert watched.watch.signal(at(1.0))["clock_uncertainty_ms"] == pytest.approx(2.0)
    assert watched.watch.signal(at(60.5))["clock_uncertainty_ms"] == pytest.approx(8.0)
    assert watched.watch.signal(at(90.0))["clock_uncertainty_ms"] is None


@pytest.mark.parametrize("time_scale", [0.5, 1.0, 20.0, 100.0])
def test_a_round_trip_is_measured_in_real_time(time_scale: float) -> None:
    """A round trip is converted to real time, at whatever time scale the client runs."""
    watched = quiet(time_scale)
    watched.watch.probed(reading(0.0, 0.005 * time_scale), at(0.0))
    assert watched.watch.signal(at(0.0))["clock_uncertainty_ms"] == pytest.approx(2.0)


@pytest.mark.parametrize(("trip_s", "codes"), [(0.020, []), (0.023, ["clock_uncertain"])])
def test_a_clock_uncertainty_above_ten_milliseconds_raises_an_alarm(
    trip_s: float, codes: list[str]
) -> None:
    """A clock uncertainty above 10 ms raises an alarm."""
    watched = quiet()
    watched.watch.probed(reading(0.0, trip_s), at(0.0))
    watched.check(0.5)
    assert [code for code, _ in watched.reported] == codes


@pytest.mark.parametrize("useless", [unanswered(1.0), reading(1.0, -0.5)])
def test_a_clock_without_a_usable_probe_is_unknown(useless: Probed) -> None:
    """Unanswered and impossible probes do not count; without valid ones an alarm is raised."""
    watched = quiet()
    for second in range(15):
        watched.watch.probed(useless, at(float(second)))
        watched.check(second + 0.5)
        watched.check(second + 1.0)
    assert watched.reported == []
    watched.wait(15.0, 0.5)
    assert watched.reported == [("clock_unknown", "raised")]
    watched.watch.probed(reading(16.0, 0.001), at(16.0))
    watched.wait(15.5, 4.0)
    assert watched.reported == [("clock_unknown", "raised"), ("clock_unknown", "cleared")]


def produced(frames: int, epoch: int = 1) -> Produced:
    """Return a client's message that it has produced this number of frames in both streams."""
    return Produced(epoch=epoch, streams={"target": frames, "actual": frames, "reports": 0})


def stored(frames: int, epoch: int = 1) -> tuple[StreamPosition, ...]:
    """Return the stored positions of both streams after this number of frames."""
    return tuple(
        StreamPosition(stream=name, epoch=epoch, next_seq=frames) for name in ("target", "actual")
    )


@pytest.mark.parametrize("time_scale", [1.0, 20.0])
def test_the_backlog_is_what_was_made_but_not_stored(time_scale: float) -> None:
    """The backlog is the duration of frames that were made but not stored, in real seconds.

    A client that runs twenty times as fast makes twenty times as many frames per second.
    """
    watched = quiet(time_scale)
    watched.play(TREMBLING.part(slice(0, 900)))
    watched.watch.backlog.acknowledged(at(0.0).monotonic_s, waiting=False)
    frames = int(900 * time_scale)
    watched.watch.produced(produced(frames + 900))
    watched.watch.backlog.stored(stored(900))
    assert watched.watch.signal(at(10.0))["behind_s"] == pytest.approx(10.0, abs=0.1)
    watched.check(10.5)
    assert ("backlog", "raised") not in watched.reported
    watched.watch.produced(produced(2 * frames + 900))
    watched.check(11.0)
    assert ("backlog", "raised") in watched.reported
    watched.watch.backlog.stored(stored(2 * frames + 900))
    assert watched.watch.signal(at(11.0))["behind_s"] == 0.0


def test_a_backlog_of_an_earlier_run_counts_too() -> None:
    """Frames of an earlier run of the client that are still in its journal count as backlog."""
    watched = Watched()
    watched.watch = type(watched.watch).of(welcome(positions=stored(900)), watched.limits, at(0.0))
    watched.watch.produced(produced(1800, epoch=1))
    watched.watch.produced(produced(90, epoch=2))
    assert watched.watch.signal(at(0.0))["behind_s"] == pytest.approx(11.0)


def test_data_waiting_for_the_disk_raise_the_backlog_alarm() -> None:
    """Data that wait for the disk raise the backlog alarm while the server does not read."""
    watched = quiet()
    watched.watch.backlog.submitted(at(0.0).monotonic_s)
    for second in range(1, 12):
        watched.watch.backlog.submitted(at(float(second)).monotonic_s)
        watched.check(float(second), reading=False)
    assert ("backlog", "raised") in watched.reported
    watched.watch.backlog.acknowledged(at(11.0).monotonic_s, waiting=False)
    assert watched.watch.signal(at(11.0))["behind_s"] == 0.0
