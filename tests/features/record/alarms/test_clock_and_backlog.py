"""How well the headset's clock is known, and how much is not on disk yet."""

import pytest

from app.wire.messages import Probed, Produced, StreamPosition
from tests.features.record.alarms.watched import TREMBLING, Watched, at, state, welcome


def reading(sent_s: float, trip_s: float, *, held_s: float = 0.001) -> Probed:
    """An exchange that took `trip_s` on the client's clock, `held_s` of it in the server."""
    received_ns = int(5e9)
    return Probed(
        client_sent_s=sent_s,
        server_received_ns=received_ns,
        server_sent_ns=received_ns + int(held_s * 1e9),
        client_received_s=sent_s + trip_s,
    )


def unanswered(sent_s: float) -> Probed:
    """An exchange that timed out."""
    return Probed(
        client_sent_s=sent_s,
        server_received_ns=None,
        server_sent_ns=None,
        client_received_s=None,
    )


def quiet(time_scale: float = 1.0) -> Watched:
    """A watch while nothing is recorded."""
    watched = Watched(time_scale)
    watched.watch.update_state(state(recording=False), at(0.0))
    return watched


def test_the_uncertainty_is_half_of_the_smallest_round_trip_of_the_last_minute() -> None:
    """What the server held it for does not count; after a minute it is forgotten."""
    watched = quiet()
    assert watched.watch.signal(at(0.0))["clock_uncertainty_ms"] is None
    watched.watch.probed(reading(0.0, 0.005), at(0.0))
    watched.watch.probed(reading(1.0, 0.017), at(1.0))
    assert watched.watch.signal(at(1.0))["clock_uncertainty_ms"] == pytest.approx(2.0)
    assert watched.watch.signal(at(60.5))["clock_uncertainty_ms"] == pytest.approx(8.0)
    assert watched.watch.signal(at(90.0))["clock_uncertainty_ms"] is None


@pytest.mark.parametrize("time_scale", [0.5, 1.0, 20.0, 100.0])
def test_a_round_trip_is_measured_in_real_time(time_scale: float) -> None:
    """However fast the client's clock runs."""
    watched = quiet(time_scale)
    watched.watch.probed(reading(0.0, 0.005 * time_scale), at(0.0))
    assert watched.watch.signal(at(0.0))["clock_uncertainty_ms"] == pytest.approx(2.0)


@pytest.mark.parametrize(("trip_s", "codes"), [(0.020, []), (0.023, ["clock_uncertain"])])
def test_more_than_ten_milliseconds_are_told(trip_s: float, codes: list[str]) -> None:
    """As little as it matters inside one clock, it matters between two."""
    watched = quiet()
    watched.watch.probed(reading(0.0, trip_s), at(0.0))
    watched.check(0.5)
    assert [code for code, _ in watched.told] == codes


@pytest.mark.parametrize("useless", [unanswered(1.0), reading(1.0, -0.5)])
def test_a_clock_without_a_usable_reading_is_unknown(useless: Probed) -> None:
    """Readings that timed out, or cannot be, do not count."""
    watched = quiet()
    for second in range(15):
        watched.watch.probed(useless, at(float(second)))
        watched.check(second + 0.5)
        watched.check(second + 1.0)
    assert watched.told == []
    watched.wait(15.0, 0.5)
    assert watched.told == [("clock_unknown", "raised")]
    watched.watch.probed(reading(16.0, 0.001), at(16.0))
    watched.wait(15.5, 4.0)
    assert watched.told == [("clock_unknown", "raised"), ("clock_unknown", "cleared")]


def produced(frames: int, epoch: int = 1) -> Produced:
    """The client has made so many frames of both streams."""
    return Produced(epoch=epoch, streams={"target": frames, "actual": frames, "reports": 0})


def stored(frames: int, epoch: int = 1) -> tuple[StreamPosition, ...]:
    """So many are on disk."""
    return tuple(
        StreamPosition(stream=name, epoch=epoch, next_seq=frames) for name in ("target", "actual")
    )


@pytest.mark.parametrize("time_scale", [1.0, 20.0])
def test_a_backlog_is_what_was_made_and_is_not_stored(time_scale: float) -> None:
    """In real seconds: a client twenty times as fast makes twenty times as many frames in one."""
    watched = quiet(time_scale)
    watched.play(TREMBLING.part(slice(0, 900)))
    watched.watch.backlog.acknowledged(at(0.0).monotonic_s, waiting=False)
    frames = int(900 * time_scale)
    watched.watch.produced(produced(frames + 900))
    watched.watch.backlog.stored(stored(900))
    assert watched.watch.signal(at(10.0))["behind_s"] == pytest.approx(10.0, abs=0.1)
    watched.check(10.5)
    assert ("backlog", "raised") not in watched.told
    watched.watch.produced(produced(2 * frames + 900))
    watched.check(11.0)
    assert ("backlog", "raised") in watched.told
    watched.watch.backlog.stored(stored(2 * frames + 900))
    assert watched.watch.signal(at(11.0))["behind_s"] == 0.0


def test_a_backlog_of_an_earlier_run_counts_too() -> None:
    """The journal of a client that was restarted still holds frames of the run before."""
    watched = Watched()
    watched.watch = type(watched.watch).of(welcome(positions=stored(900)), watched.limits, at(0.0))
    watched.watch.produced(produced(1800, epoch=1))
    watched.watch.produced(produced(90, epoch=2))
    assert watched.watch.signal(at(0.0))["behind_s"] == pytest.approx(11.0)


def test_a_disk_that_does_not_answer_is_a_backlog() -> None:
    """Though the server stops reading, so that nobody tells how much there is."""
    watched = quiet()
    watched.watch.backlog.submitted(at(0.0).monotonic_s)
    for second in range(1, 12):
        watched.watch.backlog.submitted(at(float(second)).monotonic_s)
        watched.check(float(second), reading=False)
    assert ("backlog", "raised") in watched.told
    watched.watch.backlog.acknowledged(at(11.0).monotonic_s, waiting=False)
    assert watched.watch.signal(at(11.0))["behind_s"] == 0.0
