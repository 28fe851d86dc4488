"""The state of sources: rate, gaps, jitter, order, clocks, names, and limits on all of them."""

from random import Random

import pytest

from app.adapters.live import Pose, Reading
from app.features.movement.live.sources import (
    FORGOTTEN_S,
    MAX_SOURCES,
    MAX_TRACKERS,
    SILENT_S,
    Source,
    Sources,
)

HERE = "127.0.0.1:5000"


def reading(
    *trackers: str, name: str = "", time_s: float | None = None, frame: int | None = None
) -> Reading:
    """Return what a packet with these trackers says."""
    poses = tuple(Pose(one, "tracker", (0, 0, 0), (1, 0, 0, 0)) for one in trackers)
    return Reading(poses, name, time_s, frame)


def only(sources: Sources, now_s: float) -> Source:
    """Return the one source that there is."""
    (source,) = sources.all(now_s)
    return source


def test_rate_gaps_and_jitter_of_a_tracker_are_those_of_its_arrivals() -> None:
    """90 Hz with 1 ms of jitter and two gaps of 100 ms: each figure is the one that was made."""
    random, sources, at = Random(1), Sources(), 0.0  # noqa: S311 - repeatable, no secret
    for number in range(900):
        at = number / 90 + (0.1 if number > 300 else 0) + (0.1 if number > 600 else 0)
        sources.note("osc", HERE, reading("foot"), at + random.uniform(0, 0.001))
    tracker = only(sources, at).trackers["foot"]
    assert tracker.rate_hz(at) == pytest.approx(90, rel=0.002)
    assert (tracker.samples, tracker.gaps) == (900, 2)
    assert tracker.longest_gap_s == pytest.approx(0.1 + 1 / 90, abs=0.001)
    assert tracker.jitter_s is not None
    assert 0.0005 < tracker.jitter_s < 0.001
    assert tracker.rate_hz(at + 3) is None


def test_a_clock_is_mapped_by_its_least_delayed_packets() -> None:
    """Delays of 0.2 ms and more, a drift of 50 ppm: the mapping is off by less than it says."""
    random, sources = Random(2), Sources()  # noqa: S311 - repeatable, no secret
    worst, largest, shortest = 0.0, 0.0, 0.0002
    for number in range(20 * 120):
        true_s = 1000 + number / 120
        time_s = (true_s - 700) * (1 + 50e-6)
        arrival = true_s + shortest + random.expovariate(1 / 0.002)
        sample = sources.note("natnet", HERE, reading("foot", time_s=time_s, frame=number), arrival)
        if sample is not None and sample.uncertainty_s is not None:
            worst = max(worst, abs(sample.mapped_s - true_s - shortest) - sample.uncertainty_s)
            largest = max(largest, sample.uncertainty_s)
    assert worst <= 0.0001
    assert largest < 0.001


def test_doubled_late_and_skipped_packets_are_counted_and_change_nothing() -> None:
    """Frames 1 2 2 5 3 4 6: one doubled, two late, two skipped; the newest pose stays.

    What came late is for the record, and marked.
    """
    sources = Sources()
    taken = [
        (number, sample.is_late)
        for at, number in enumerate((1, 2, 2, 5, 3, 4, 6))
        if (sample := sources.note("json", HERE, reading("foot", name="a", frame=number), at / 100))
    ]
    source = only(sources, 0.1)
    assert taken == [(1, False), (2, False), (5, False), (3, True), (4, True), (6, False)]
    assert (source.doubled, source.late, source.skipped, source.restarts) == (1, 2, 2, 0)
    assert source.trackers["foot"].samples == 4


def test_a_source_without_a_counter_is_ordered_by_its_time() -> None:
    """One frame in two packets is not doubled; the same tracker at the same time is."""
    sources = Sources()
    for at, (time_s, name) in enumerate(
        ((1.0, "left"), (1.0, "right"), (1.0, "right"), (1.1, "left"), (1.05, "left"))
    ):
        sources.note("osc", HERE, reading(name, time_s=time_s), at / 100)
    source = only(sources, 0.1)
    assert (source.ordered, source.doubled, source.late) == (True, 1, 1)
    sources.note("osc", "127.0.0.1:5001", reading("left"), 0.1)
    assert [one.ordered for one in sources.all(0.1)] == [True, False]


def test_a_restarted_source_begins_anew() -> None:
    """A counter far back, a time far back, and a little back for ten packets mean a restart."""
    for before, after in (((500, None), (0, None)), ((None, 90.0), (None, 0.0))):
        sources = Sources()
        sources.note("json", HERE, reading("x", frame=before[0], time_s=before[1]), 10)
        assert sources.note("json", HERE, reading("x", frame=after[0], time_s=after[1]), 11)
        assert (only(sources, 11).restarts, only(sources, 11).late) == (1, 0)
    sources = Sources()
    for number in (50, *range(12)):
        sources.note("json", HERE, reading("x", frame=number), 10)
    assert (only(sources, 10).restarts, only(sources, 10).late) == (1, 10)


def test_two_senders_of_one_name_are_two_sources() -> None:
    """Neither disturbs the order, the rate or the clock of the other."""
    sources = Sources()
    for number in range(90):
        for port, start in ((5000, 0), (5001, 1000)):
            packet = reading("foot", name="rig", frame=start + number, time_s=start + number / 90)
            sources.note("json", f"127.0.0.1:{port}", packet, number / 90)
    first, second = sources.all(1)
    assert (first.label, second.label) == ("rig", "rig")
    for one in (first, second):
        assert (one.late, one.doubled, one.skipped, one.restarts) == (0, 0, 0, 0)
        assert one.trackers["foot"].rate_hz(1) == pytest.approx(90)
    assert (first.clock.offset_s, second.clock.offset_s) == (0, -1000)


def test_a_damaged_packet_counts_at_its_sender_and_leaves_the_order() -> None:
    """It has no name, but it comes from the same address."""
    sources = Sources()
    sources.note("json", HERE, reading("foot", name="rig"), 1)
    damaged = Reading()
    damaged.problems["malformed"] += 1
    sources.note("json", HERE, damaged, 2)
    source = only(sources, 2)
    assert (source.packets, source.problems) == (2, {"malformed": 1})


def test_sources_and_trackers_are_limited_and_silence_makes_room() -> None:
    """Neither invented trackers nor invented senders take memory without end."""
    sources = Sources()
    for number in range(MAX_TRACKERS + 5):
        sources.note("osc", HERE, reading(str(number)), 0)
    assert len(only(sources, 0).trackers) == MAX_TRACKERS
    assert only(sources, 0).problems == {"limit": 5}
    for number in range(MAX_SOURCES + 5):
        sources.note("osc", f"127.0.0.2:{number}", reading("x"), 1)
    assert (len(list(sources.all(1))), sources.turned_away) == (MAX_SOURCES, {"osc": 6})
    sources.note("osc", "127.0.0.3:1", reading("x"), 1 + SILENT_S + 0.1)
    assert HERE not in [one.key.address for one in sources.all(4)]
    assert not list(sources.all(4 + FORGOTTEN_S))
    sources.forget("osc")
    assert sources.turned_away.total() == 0


def test_software_that_was_started_anew_replaces_its_silent_self() -> None:
    """From the same computer, under the same name, after a silence: a restart and no second one."""
    sources = Sources()
    for number in range(3):
        at = number * (SILENT_S + 1)
        sources.note("json", f"127.0.0.1:{5000 + number}", reading("a", name="rig"), at)
        source = only(sources, at)
        assert (source.key.address, source.restarts) == (f"127.0.0.1:{5000 + number}", number)
    late = at + SILENT_S + 1
    sources.note("json", "127.0.0.2:5000", reading("a", name="rig"), late)
    sources.note("json", "127.0.0.2:5001", reading("a", name="rig"), late)
    assert len(list(sources.all(late))) == 3


def test_a_counter_that_jumps_far_ahead_was_set_anew_and_lost_nothing() -> None:
    """One packet with a senseless number does not turn into 10^18 lost ones."""
    sources = Sources()
    for at, frame in enumerate((1, 2, 2**62, 2**62 + 3)):
        sources.note("json", HERE, reading("a", name="rig", frame=frame), at)
    source = only(sources, 4)
    assert (source.skipped, source.restarts, source.late) == (2, 1, 0)
