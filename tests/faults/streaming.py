"""Run headsets that only stream, each with a journal of what it sent and was acknowledged."""

import asyncio
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import httpx2

from app.client.telemetry import TelemetryClient
from app.rehearsal.rehearse import AVATARS
from app.wire import BODY_STREAMS
from app.wire.messages import MaterialisedReport
from tests.benchmarks.headsets import FRAMES_PER_BATCH, RATE_HZ, batch_of, movement
from tests.rehearsal.ledger import LedgerJournal
from tests.rehearsal.performed import STUDY
from tests.support.server import ADMIN_PASSWORD, LiveServer

BATCHES_PER_REPORT = 15
MOST_WAITING = 400
"""The most unacknowledged messages of a headset that does not stream in real time."""


@dataclass(frozen=True)
class StreamingHeadset:
    """A headset that only streams, paired with a session that has not started."""

    session_id: str
    token: str
    ledger: LedgerJournal = field(default_factory=LedgerJournal)


@contextmanager
def signed_in(server: LiveServer) -> Iterator[httpx2.Client]:
    """Yield an operator's HTTP client."""
    with server.client() as client:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()
        yield client


def pair_headsets(server: LiveServer, count: int) -> list[StreamingHeadset]:
    """Create `count` new sessions, each with a paired headset."""
    with signed_in(server) as client:
        return [_paired(client) for _ in range(count)]


def _paired(client: httpx2.Client) -> StreamingHeadset:
    session = _post(client, f"/api/studies/{STUDY}/sessions", {"kind": "simulated"})
    shown = _post(client, f"/api/sessions/{session['id']}/pairings", {"device": "headset"})
    token = _post(client, "/api/devices/pair", {"code": shown["code"]})["token"]
    return StreamingHeadset(session["id"], token)


def _post(client: httpx2.Client, path: str, body: dict[str, str]) -> dict[str, Any]:
    response = client.post(path, json=body)
    response.raise_for_status()
    answered: dict[str, Any] = response.json()
    return answered


async def stream(
    server: LiveServer,
    headsets: Sequence[StreamingHeadset],
    more: Callable[[], bool],
    *,
    real_time: bool = True,
) -> None:
    """Stream from all headsets in parallel while `more()`; return when everything is acknowledged.

    In real time each makes 90 frames a second however slow the server is, as a body does; otherwise
    each makes as many as the server accepts.
    """
    async with asyncio.TaskGroup() as group:
        for seed, headset in enumerate(headsets):
            group.create_task(_stream_one(server, headset, seed, more, real_time=real_time))


async def _stream_one(
    server: LiveServer,
    headset: StreamingHeadset,
    seed: int,
    more: Callable[[], bool],
    *,
    real_time: bool,
) -> None:
    url = f"{server.url.replace('http', 'ws', 1)}/api/vr/stream"
    began_s = time.monotonic()

    def now_s() -> float:
        return time.monotonic() - began_s

    values = movement(seed)
    async with TelemetryClient(
        url, headset.token, f"fault {seed}", now_s, avatars=AVATARS, journal=headset.ledger
    ) as client:
        batch = 0
        while more():
            seq = batch * FRAMES_PER_BATCH
            for name in BODY_STREAMS:
                message = batch_of(name, client.epoch, seq, values)
                await client.send_batch(name, seq + FRAMES_PER_BATCH, message)
            if batch % BATCHES_PER_REPORT == 0:
                # Rejected, since the session has not started, but stored and acknowledged like any
                # other.
                await client.report(MaterialisedReport(t_s=seq / RATE_HZ))
            batch += 1
            if real_time:
                await asyncio.sleep(max(0.0, batch * FRAMES_PER_BATCH / RATE_HZ - now_s()))
            else:
                await client.at_most_waiting(MOST_WAITING)
        await client.drained()
