"""Tests that bursts and clients that do not read leave memory bounded and lose no data."""

import asyncio
import socket
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field

import numpy as np
import psutil
import pytest

from app.client.journal import Entry
from app.client.telemetry import TelemetryClient
from app.wire import BODY_STREAMS
from tests.benchmarks.headsets import batch_of, movement
from tests.faults.figures import note
from tests.faults.streaming import StreamingHeadset, pair_headsets, signed_in, stream
from tests.features.record.headset.site import open_site
from tests.rehearsal.ledger import LedgerJournal, reconcile
from tests.support.server import LiveServer

FRAMES = 6
HEADSETS, BURST = 4, 10
MOST_GROWTH_MIB = 150
READERS, ALONE_S, STREAM_S = 10, 1.0, 4.0


@dataclass
class TimedLedger(LedgerJournal):
    """A journal that also measures the time from each message to its acknowledgement."""

    added_s: dict[int, float] = field(default_factory=dict)
    waited_s: list[float] = field(default_factory=list)

    def add(self, entry: Entry) -> None:
        """Record when the message was added."""
        self.added_s[self.end] = time.monotonic()
        super().add(entry)

    def acknowledge(self, positions: Iterable[tuple[str, int, int]]) -> None:
        """Record how long the acknowledged messages waited."""
        first = self.first
        super().acknowledge(list(positions))
        for place in range(first, self.first):
            self.waited_s.append(time.monotonic() - self.added_s.pop(place))


@contextmanager
def watched_memory(server: LiveServer) -> Iterator[list[int]]:
    """Sample the server's resident bytes while the block runs."""
    process, seen, done = psutil.Process(server.pid), [], threading.Event()

    def look() -> None:
        while not done.wait(0.05):
            seen.append(process.memory_info().rss)

    looking = threading.Thread(target=look)
    looking.start()
    try:
        yield seen
    finally:
        done.set()
        looking.join()


@pytest.mark.timeout(120)
@pytest.mark.parametrize("burst_s", [2.0, pytest.param(5.0, marks=pytest.mark.long)])
def test_a_burst_is_stored_without_loss(live_server: LiveServer, burst_s: float) -> None:
    """A burst from four headsets at ten times their rate is queued and stored completely."""
    headsets = [
        StreamingHeadset(one.session_id, one.token, TimedLedger())
        for one in pair_headsets(live_server, HEADSETS)
    ]
    with watched_memory(live_server) as rss:
        asyncio.run(_burst(live_server, headsets, burst_s))
    growth_mib = (max(rss) - rss[0]) / 2**20
    waited_s = np.concatenate(
        [one.ledger.waited_s for one in headsets if isinstance(one.ledger, TimedLedger)]
    )
    with open_site(live_server) as site, site.database.reading() as db:
        found = [reconcile(db, one.session_id, one.ledger) for one in headsets]
    told = f"{HEADSETS} headsets at {BURST}x for {burst_s:g} s"
    note(20, told, "acknowledged and lost", sum(one.lost for one in found))
    note(20, told, "server memory, growth at most (MiB)", growth_mib)
    note(20, told, "acknowledgement p99 (s)", float(np.percentile(waited_s, 99)))
    assert all(one.sound and one.sent == one.stored for one in found)
    assert growth_mib < MOST_GROWTH_MIB


async def _burst(server: LiveServer, headsets: list[StreamingHeadset], burst_s: float) -> None:
    async with asyncio.TaskGroup() as group:
        for one in headsets:
            group.create_task(_burst_one(server, one, burst_s))


async def _burst_one(server: LiveServer, headset: StreamingHeadset, burst_s: float) -> None:
    url = f"{server.url.replace('http', 'ws', 1)}/api/vr/stream"
    async with TelemetryClient(
        url, headset.token, "burst", time.monotonic, journal=headset.ledger
    ) as client:
        began_s, values = time.monotonic(), movement(1)
        for at in range(int(90 * BURST * burst_s / FRAMES)):
            for name in BODY_STREAMS:
                await client.send_batch(
                    name, (at + 1) * FRAMES, batch_of(name, client.epoch, at * FRAMES, values)
                )
            due_s = began_s + (at + 1) * FRAMES / (90 * BURST)
            await asyncio.sleep(max(0.0, due_s - time.monotonic()))
        await client.drained()


@pytest.mark.timeout(120)
def test_consoles_that_do_not_read_delay_no_headset(live_server: LiveServer) -> None:
    """Ten consoles that never read lose only their own events, and delay no headset."""
    (headset,) = pair_headsets(live_server, 1)
    (other,) = pair_headsets(live_server, 1)
    before_s = _stream_for(live_server, headset, ALONE_S)
    with ExitStack() as stack, watched_memory(live_server) as rss:
        for _ in range(READERS):
            stack.enter_context(_unread(live_server, other.session_id))
        with_readers_s = _stream_for(live_server, other, STREAM_S)
    growth_mib = (max(rss) - rss[0]) / 2**20
    with open_site(live_server) as site, site.database.reading() as db:
        found = reconcile(db, other.session_id, other.ledger)
    told = f"{READERS} unread consoles"
    note(
        24,
        told,
        "acknowledgement p99, without and with (ms)",
        f"{1000 * before_s:.0f} and {1000 * with_readers_s:.0f}",
    )
    note(24, told, "server memory, growth at most (MiB)", growth_mib)
    assert found.sound
    assert found.sent == found.stored
    assert growth_mib < MOST_GROWTH_MIB


def _stream_for(server: LiveServer, headset: StreamingHeadset, for_s: float) -> float:
    """Stream in real time and return the 99th percentile of acknowledgement times."""
    ledger = TimedLedger()
    timed = StreamingHeadset(headset.session_id, headset.token, ledger)
    until_s = time.monotonic() + for_s
    asyncio.run(stream(server, [timed], lambda: time.monotonic() < until_s))
    headset.ledger.sent.update(ledger.sent)
    headset.ledger.acked.update(ledger.acked)
    return float(np.percentile(ledger.waited_s, 99))


@contextmanager
def _unread(server: LiveServer, session_id: str) -> Iterator[None]:
    """Open a console's live stream with a small window and never read it."""
    with signed_in(server) as client, socket.socket() as connection:
        cookies = "; ".join(f"{name}={value}" for name, value in client.cookies.items())
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        connection.connect(("127.0.0.1", server.port))
        connection.sendall(
            f"GET /api/sessions/{session_id}/live HTTP/1.1\r\nHost: localhost:{server.port}\r\n"
            f"Cookie: {cookies}\r\n\r\n".encode()
        )
        yield
