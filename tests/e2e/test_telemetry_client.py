"""Browser tests of the telemetry client: nothing is lost or duplicated on the real server."""

import sys
import time

import pytest

from tests.e2e.telemetry_bench import (
    BATCHES_PER_S,
    FRAMES_PER_BATCH,
    MEBIBYTE,
    RATE_HZ,
    Meter,
    Mode,
    Wear,
    reconciled,
)
from tests.features.record.headset.site import Site

BACKLOG_FRAMES = 54_000
"""Ten minutes of one stream."""


@pytest.mark.parametrize(
    ("mode", "stream_s"), [("worker", 5), pytest.param("page", 10, marks=pytest.mark.long)]
)
def test_streamed_data_arrive_bit_by_bit(
    wear: Wear, headset_site: Site, mode: Mode, stream_s: int
) -> None:
    """Streaming at real speed stores every frame and report bit by bit, with few disk writes."""
    headset = wear(mode=mode)
    epoch = headset.open()
    meter = Meter.of(headset.page)
    before_s = meter.task_s()
    headset.produce(stream_s * BATCHES_PER_S, speed=1.0)
    headset.drained()
    cost_s, writes = meter.task_s() - before_s, headset.tell("bench.journalWrites")
    made = headset.made
    messages = 2 * made.frames // FRAMES_PER_BATCH + made.reports
    found = reconciled(headset_site.server, headset.session_id, {epoch: made})
    assert made.frames == stream_s * RATE_HZ
    assert (found.stored, found.sound) == (found.sent, True)
    assert headset.tell("bench.notices") > 0, "the broken samples were not flagged"
    assert headset.status["level"] == "clear"
    sys.stdout.write(
        f"\nstreaming, client in the {mode}: {messages / stream_s:.1f} messages/s, "
        f"{1000 * cost_s / messages:.3f} ms of the main thread a message"
        + (f", {writes / stream_s:.1f} journal writes/s\n" if mode == "page" else "\n")
    )


def test_a_killed_server_gets_everything_once(wear: Wear, headset_site: Site) -> None:
    """After two SIGKILLs of the server in mid-stream, every message is stored exactly once."""
    headset = wear()
    epoch = headset.open()
    headset.begin(6 * BATCHES_PER_S, speed=1.0)
    for _ in range(2):
        time.sleep(1.0)
        headset_site.server.kill()
        time.sleep(0.5)
        headset_site.server.start()
        headset.wait_for("bench.client.status.connected")
    headset.wait_for(f"bench.error !== null || bench.produced.frames === {6 * RATE_HZ}")
    headset.drained()
    found = reconciled(headset_site.server, headset.session_id, {epoch: headset.made})
    assert headset.tell("bench.error") is None
    assert (found.stored, found.sound) == (found.sent, True)


@pytest.mark.long
def test_ten_minutes_offline_are_sent_later(wear: Wear, headset_site: Site) -> None:
    """After ten minutes offline, 54,000 frames of each stream are sent from the disk's journal."""
    headset = wear(mode="page")
    epoch = headset.open()
    meter = Meter.of(headset.page)
    empty = meter.heap_bytes()
    headset_site.server.stop()
    headset.wait_for("!bench.client.status.connected")
    headset.begin(BACKLOG_FRAMES // FRAMES_PER_BATCH, speed=None)
    peak = empty
    while headset.tell("bench.error") is None and headset.made.frames < BACKLOG_FRAMES:
        peak = max(peak, meter.heap_bytes())
    headset.flush()
    headset.wait_for("bench.client.status.level === 'behind'")
    waiting, behind = headset.status, meter.heap_bytes()
    headset_site.server.start()
    drained_s = headset.drained()
    found = reconciled(headset_site.server, headset.session_id, {epoch: headset.made})
    assert headset.tell("bench.error") is None
    assert (found.stored, found.sound) == (found.sent, True)
    assert waiting["journaledMessages"] == 2 * BACKLOG_FRAMES // FRAMES_PER_BATCH + 600
    assert peak - empty < 24 * MEBIBYTE
    sys.stdout.write(
        f"\nten minutes offline: {waiting['journaledBytes'] / MEBIBYTE:.1f} MiB waited, heap "
        f"{empty / MEBIBYTE:.1f} MiB empty, {peak / MEBIBYTE:.1f} at most while it filled, "
        f"{behind / MEBIBYTE:.1f} full; drained {drained_s:.1f} s after the connection\n"
    )


def test_a_full_journal_blocks_the_producer(wear: Wear, headset_site: Site) -> None:
    """At the journal's limit the producer waits, the status reports it, and no data are lost."""
    headset = wear(journalBytes=MEBIBYTE)
    epoch = headset.open()
    headset_site.server.stop()
    headset.begin(30 * BATCHES_PER_S, speed=None)
    headset.wait_for("bench.client.status.level === 'full'")
    held = headset.made
    time.sleep(0.5)
    assert headset.made == held
    assert headset.status["journaledBytes"] == pytest.approx(MEBIBYTE, rel=0.01)
    assert headset.status["waitingCalls"] == 1
    headset_site.server.start()
    headset.wait_for(f"bench.error !== null || bench.produced.frames === {30 * RATE_HZ}")
    headset.drained()
    found = reconciled(headset_site.server, headset.session_id, {epoch: headset.made})
    assert headset.tell("bench.error") is None
    assert (found.stored, found.sound) == (found.sent, True)
    assert "full" in headset.tell("bench.levels")
    headset.wait_for("bench.client.status.level === 'clear'")


def test_a_replaced_headset_reports_the_servers_reason(wear: Wear, headset_site: Site) -> None:
    """A replaced headset reports the server's reason and keeps its journal."""
    headset = wear()
    headset.open()
    headset_site.token(headset.session_id)
    headset.wait_for("bench.client.status.failure !== null")
    failure = headset.status["failure"]
    assert failure["code"] == "not_signed_in"
    assert failure["remedy"]
