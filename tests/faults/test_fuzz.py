"""Tests that each malformed message is rejected without affecting other sessions."""

import asyncio
import contextlib
import json
from collections.abc import Callable

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed

from app.errors import InvalidInput
from app.features.record.headset.connection import parse_message
from app.wire import MalformedBatchError, decode_batch, flag_frames
from tests.faults.figures import note
from tests.faults.streaming import pair_headsets, stream
from tests.features.record.headset.site import HELLO, Site, open_site
from tests.rehearsal.ledger import reconcile
from tests.support.server import LiveServer
from tests.wire.samples import message, standing

SHORT, LONG, OVER_SOCKETS = 20_000, 1_000_000, 150
BATCH = message(standing(6))
TEXTS = (
    {**HELLO, "epoch": None},
    {"type": "report", "epoch": 1, "seq": 0, "body": {"kind": "materialised", "t_s": 1.0}},
    {"type": "probe", "client_sent_s": 1.5},
    {"type": "produced", "epoch": 1, "streams": {"target": 5}},
    {
        "type": "probed",
        "client_sent_s": 1.0,
        "server_received_ns": 5,
        "server_sent_ns": 6,
        "client_received_s": 1.1,
    },
)
ODD = ("null", "-1", "1e400", "NaN", '""', "[]", "{}", "true", "9" * 400, '"\\u0000"', "[" * 2000)


def malformed_batch(rng: np.random.Generator) -> bytes:
    """Return a batch with bytes changed, cut or duplicated, or random bytes."""
    data = bytearray(BATCH)
    match int(rng.integers(5)):
        case 0:
            return rng.bytes(int(rng.integers(0, 4000)))
        case 1:
            return bytes(data[: int(rng.integers(0, len(data)))])
        case 2:
            for at in rng.integers(0, 64, 3):
                data[at] = int(rng.integers(256))
        case 3:
            for at in rng.integers(0, len(data), 8):
                data[at] ^= 1 << int(rng.integers(8))
        case _:
            return bytes(data) + rng.bytes(int(rng.integers(1, 100)))
    return bytes(data)


def malformed_text(rng: np.random.Generator) -> str:
    """Return a message with a value replaced, a part removed, or random characters inserted."""
    text = json.dumps(TEXTS[int(rng.integers(len(TEXTS)))])
    at, end = sorted(rng.integers(0, len(text) + 1, 2).tolist())
    match int(rng.integers(3)):
        case 0:
            return text[:at] + text[end:]
        case 1:
            return text[:at] + ODD[int(rng.integers(len(ODD)))] + text[end:]
        case _:
            noise = "".join(chr(int(c)) for c in rng.integers(1, 0xD800, 20))
            return text[:at] + noise + text[at:]


def crashes(rng: np.random.Generator, count: int) -> int:
    """Return how many messages raised anything but the expected rejection."""
    wrong = 0
    for at in range(count):
        try:
            if at % 2:
                batch = decode_batch(malformed_batch(rng))
                flag_frames(batch.times_s, batch.values)
            else:
                parse_message(malformed_text(rng))
        except (MalformedBatchError, InvalidInput):
            continue
        except Exception:  # noqa: BLE001 - that is what is counted
            wrong += 1
    return wrong


def test_a_malformed_message_raises_only_its_own_error() -> None:
    """A malformed message never raises any error except the one for malformed input."""
    found = crashes(np.random.default_rng(21), SHORT)
    note(21, f"malformed messages ({SHORT:,})", "crashes", found)
    assert found == 0


@pytest.mark.long
@pytest.mark.timeout(1800)
def test_a_million_malformed_messages() -> None:
    """None of a million malformed messages raises an unexpected error."""
    found = crashes(np.random.default_rng(22), LONG)
    note(21, f"malformed messages ({LONG:,})", "crashes", found)
    assert found == 0


@pytest.mark.timeout(120)
def test_malformed_messages_do_not_affect_other_sessions(live_server: LiveServer) -> None:
    """While one headset sends malformed messages, the server and another session are unaffected."""
    (healthy,) = pair_headsets(live_server, 1)
    before = live_server.pid
    with open_site(live_server) as site:
        token = site.token(site.join())
        done = asyncio.Event()

        async def run() -> None:
            async with asyncio.TaskGroup() as group:
                group.create_task(stream(live_server, [healthy], lambda: not done.is_set()))
                try:
                    await asyncio.to_thread(_send_rubbish, site, token)
                finally:
                    done.set()

        asyncio.run(run())
        with site.database.reading() as db:
            found = reconcile(db, healthy.session_id, healthy.ledger)
    assert live_server.pid == before
    assert "Traceback" not in live_server.log
    note(21, f"rubbish over {OVER_SOCKETS} sockets", "frames of the other session lost", found.lost)
    assert found.sound
    assert found.sent == found.stored


def _send_rubbish(site: Site, token: str) -> None:
    rng = np.random.default_rng(23)
    make: tuple[Callable[[np.random.Generator], bytes | str], ...] = (
        malformed_batch,
        malformed_text,
    )
    for at in range(OVER_SOCKETS):
        with contextlib.suppress(ConnectionClosed), site.headset(token) as headset:
            headset.socket.send(make[at % 2](rng))
            with contextlib.suppress(TimeoutError):
                while True:
                    headset.socket.recv(timeout=0.05)
