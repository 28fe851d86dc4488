"""Tests that too large requests are rejected before they fill the memory."""

import asyncio
import socket
import ssl
import time
from collections.abc import Iterator
from contextlib import contextmanager

import psutil
import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from app.settings import Settings
from app.wire.messages import PROTOCOL_VERSION, SUBPROTOCOL
from tests.faults.figures import note
from tests.faults.streaming import pair_headsets
from tests.faults.test_pressure import watched_memory
from tests.support.lan import LanServer
from tests.support.server import ADMIN_PASSWORD

MOST_GROWTH_MIB = 64


@pytest.fixture(scope="module")
def lan(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LanServer]:
    """Provide a server with all its network ports open."""
    with LanServer(tmp_path_factory.mktemp("large")) as server:
        yield server


@contextmanager
def _bounded(lan: LanServer, what: str) -> Iterator[None]:
    """Report how much the server's memory grew, and assert that it stayed below the limit."""
    before = psutil.Process(lan.pid).memory_info().rss
    with watched_memory(lan) as rss:
        yield
        time.sleep(0.2)
    growth_mib = (max(rss) - before) / 2**20
    note(22, what, "server memory, growth at most (MiB)", growth_mib)
    assert growth_mib < MOST_GROWTH_MIB


def test_too_large_a_body_is_refused(lan: LanServer) -> None:
    """A body that is too large gets 413 before it fills the memory, even if undeclared."""
    limit = Settings().max_body_bytes
    with lan.client() as client:
        client.get("/api/health")
        with _bounded(lan, "256 MiB body, declared"):
            declared = client.post(
                "/api/login", content=_blocks(256), headers={"content-length": str(2**28)}
            )
        assert declared.status_code == 413
    with _bounded(lan, "256 MiB body, in chunks"):
        assert b"413" in _sent_in_chunks(lan.port, 256)
    note(22, "bodies", "refused above (bytes)", limit)


def test_an_anonymous_body_is_not_read_after_413(lan: LanServer) -> None:
    """After a 413, no more of an anonymous client's body is read and the connection is closed."""
    with socket.create_connection(("127.0.0.1", lan.port), timeout=30) as connection:
        connection.sendall(
            b"POST /api/login HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
            b"Content-Length: 268435456\r\n\r\n"
        )
        answer = connection.recv(4096)
        sent = _sent_until_closed(connection)
    assert answer.startswith(b"HTTP/1.1 413")
    # The system's buffers accept data that the server never reads.
    assert sent < 2**26


def _sent_until_closed(connection: socket.socket) -> int:
    sent = 0
    try:
        for block in _blocks(256):
            connection.sendall(block)
            sent += len(block)
    except OSError:
        pass
    return sent


def test_too_large_a_capture_is_refused(lan: LanServer) -> None:
    """A capture above the larger limit for captures gets 413; an anonymous upload gets 401."""
    most = Settings().max_capture_bytes
    address = "/api/captures?name=walk.bvh"
    with lan.client() as client:
        with _bounded(lan, "63 MiB capture of a stranger"):
            stranger = client.post(address, content=_blocks(63))
        assert stranger.status_code == 401
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()
        with _bounded(lan, "256 MiB capture, declared"):
            declared = client.post(
                address, content=_blocks(256), headers={"content-length": str(2**28)}
            )
        assert declared.status_code == 413
        assert str(most) in declared.json()["error"]["valid"]
        cookie = f"reembody_login={client.cookies['reembody_login']}"
        with _bounded(lan, "256 MiB capture, in chunks"):
            assert b"413" in _sent_in_chunks(lan.port, 256, address, cookie)
        with _bounded(lan, "63 MiB capture that is none"):
            unreadable = client.post(address, content=_blocks(63), timeout=120.0)
        assert unreadable.status_code == 422
    note(22, "captures", "refused above (bytes)", most)


def _blocks(mebibytes: int) -> Iterator[bytes]:
    yield from (b" " * 2**20 for _ in range(mebibytes))


def _sent_in_chunks(
    port: int, mebibytes: int, address: str = "/api/login", cookie: str = ""
) -> bytes:
    """Send chunks until the server responds, which it does long before the end of the body."""
    with socket.create_connection(("127.0.0.1", port), timeout=30) as connection:
        head = f"POST {address} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        head += f"Cookie: {cookie}\r\nTransfer-Encoding: chunked\r\n\r\n"
        connection.sendall(head.encode())
        try:
            for block in _blocks(mebibytes):
                connection.sendall(b"%x\r\n" % len(block) + block + b"\r\n")
        except OSError:
            pass
        return connection.recv(65536)


def test_too_large_a_frame_is_refused(lan: LanServer) -> None:
    """A frame that is too large closes the headset's socket with code 1009, over ws and wss."""
    (headset,) = pair_headsets(lan, 1)
    for url, trust in ((lan.url, None), (lan.secure_url, lan.trusting())):
        scheme = url.partition(":")[0]
        with _bounded(lan, f"64 MiB frame over {scheme.replace('http', 'ws')}"):
            code = asyncio.run(_closed_with(url, headset.token, trust))
        note(22, "64 MiB frame", f"close code over {scheme.replace('http', 'ws')}", code)
        assert code == 1009


async def _closed_with(url: str, token: str, trust: ssl.SSLContext | None) -> int | None:
    async with connect(
        f"{url.replace('http', 'ws', 1)}/api/vr/stream",
        subprotocols=[SUBPROTOCOL, f"bearer.{token}"],  # type: ignore[list-item]  # a token is a plain str
        ssl=trust,
    ) as connection:
        hello = f'{{"type": "hello", "protocol": {PROTOCOL_VERSION}, "client": "test"}}'
        await connection.send(hello)
        try:
            await connection.send(bytes(2**26))
            async for _ in connection:
                continue
        except ConnectionClosed:
            pass
        return connection.close_code
