"""Tests of the Python client on the real server: frames produced, stored and missing."""

import asyncio
import time
from pathlib import Path

from sqlalchemy import select

from app.client.file_journal import FileJournal
from app.client.journal import Journal
from app.client.telemetry import TelemetryClient
from app.features.record.receipts import receipt_of
from app.features.record.receipts.service import SessionReceipt
from app.features.record.telemetry import concatenate, iter_frames
from app.models import TelemetryStream
from app.wire import StreamName
from tests.faults.record import record_of
from tests.features.record.headset.site import Site, open_site
from tests.support.server import LiveServer
from tests.wire.samples import message, standing

FRAMES = 9


def client(site: Site, token: str, journal: Journal) -> TelemetryClient:
    """Return a client of the site's server."""
    url = f"{site.server.url.replace('http', 'ws', 1)}/api/vr/stream"
    return TelemetryClient(url, token, "test", time.monotonic, journal=journal)


async def send(headset: TelemetryClient, batches: int, first: int = 0) -> None:
    """Append this many batches of the target stream to the journal."""
    for at in range(first, first + batches):
        text = message(standing(FRAMES), seq_first=at * FRAMES, epoch=headset.epoch)
        await headset.send_batch(StreamName.TARGET, (at + 1) * FRAMES, text)


def receipt(server: LiveServer, session_id: str) -> SessionReceipt:
    """Return the receipt of a session."""
    with record_of(server) as db:
        return receipt_of(db, session_id)


def test_a_clean_end_reports_how_much_was_produced(live_server: LiveServer) -> None:
    """After a clean end the server knows the number of frames, and the receipt is complete."""
    with open_site(live_server) as site:
        session_id = site.join()
        token = site.token(session_id)

        async def run() -> None:
            async with client(site, token, Journal()) as headset:
                await send(headset, 20)
                await headset.drained()

        asyncio.run(run())
        produced = _produced(live_server, session_id)
    assert produced == {("target", 1): 180}
    assert receipt(live_server, session_id).complete


def test_frames_of_a_lost_journal_are_counted_as_missing(
    live_server: LiveServer,
) -> None:
    """Frames that a headset reported but never sent are counted as missing in the receipt."""
    with open_site(live_server) as site:
        session_id = site.join()
        token = site.token(session_id)

        async def run() -> None:
            async with client(site, token, Journal()) as headset:
                await send(headset, 10)
                await headset.drained()
                # The next frames never leave the headset, but it has reported them.
                for at in range(10, 15):
                    headset.journal.produced_up_to(StreamName.TARGET, 1, (at + 1) * FRAMES)

        asyncio.run(run())
        _produced(live_server, session_id)
    found = receipt(live_server, session_id)
    stream = next(one for one in found.streams if one.stream == "target")
    assert (stream.sent, stream.stored, stream.missing) == (135, 90, 45)
    assert stream.gaps == ((90, 135),)
    assert not found.complete


def test_a_journal_in_files_is_delivered_by_the_next_process(
    live_server: LiveServer, tmp_path: Path
) -> None:
    """A journal in files is delivered by the next process under its original epoch."""
    with open_site(live_server) as site:
        session_id = site.join()
        token = site.token(session_id)

        async def first() -> None:
            journal = FileJournal(folder=tmp_path / "journal")
            async with client(site, token, journal) as headset:
                await send(headset, 10)
                await headset.drained()
                live_server.kill()
                await send(headset, 30, first=10)
            journal.close()

        async def second() -> None:
            journal = FileJournal(folder=tmp_path / "journal")
            async with client(site, token, journal) as headset:
                assert headset.epoch == 2
                await send(headset, 5)
                await headset.drained()
            journal.close()

        asyncio.run(first())
        live_server.start()
        asyncio.run(second())
        found = receipt(live_server, session_id)
    assert found.complete
    assert {(one.stream, one.epoch): one.stored for one in found.streams if one.stored} == {
        ("target", 1): 360,
        ("target", 2): 45,
    }
    with record_of(live_server) as db:
        frames = concatenate([f for _, f in iter_frames(db, session_id, "target", 1)])
    assert frames.seq.tolist() == list(range(360))


def _produced(server: LiveServer, session_id: str) -> dict[tuple[str, int], int]:
    """Return the number of frames that the client reported, once it is stored."""
    give_up_s = time.monotonic() + 10.0
    while True:
        with record_of(server) as db:
            rows = db.scalars(
                select(TelemetryStream).where(TelemetryStream.session_id == session_id)
            ).all()
        produced = {(row.stream, row.epoch): row.produced for row in rows if row.produced}
        if produced or time.monotonic() > give_up_s:
            return produced
        time.sleep(0.02)
