"""Tests that clients with unfinished requests are closed in time and others are served."""

import asyncio
import socket
import time
from collections.abc import Iterator
from http.client import HTTPConnection

import httpx2
import numpy as np
import pytest

from app.lan.serving.deadlines import (
    BODY_WITHIN_S,
    HEAD_WITHIN_S,
    MOST_HEAD_BYTES,
    MOST_UNFINISHED,
    PORTION_BYTES,
)
from app.lan.serving.listening import HANDSHAKE_WITHIN_S
from tests.faults.figures import note
from tests.support.lan import LanServer
from tests.support.server import ADMIN_PASSWORD, LiveServer

LORISES = 500
MARGIN_S = 5.0
ASKED = 200


@pytest.fixture(scope="module")
def lan(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LanServer]:
    """Provide a server with all its network ports open."""
    with LanServer(tmp_path_factory.mktemp("slow")) as server:
        yield server


async def _healthy(server: LiveServer, count: int) -> list[float]:
    """Return the response times, in seconds, of `count` requests one after the other."""
    took_s = []
    async with httpx2.AsyncClient(base_url=server.url, timeout=30.0) as client:
        for _ in range(count):
            began_s = time.perf_counter()
            (await client.get("/api/health")).raise_for_status()
            took_s.append(time.perf_counter() - began_s)
            await asyncio.sleep(0.01)
    return took_s


async def _loris(port: int, stop: asyncio.Event) -> float:
    """Send a request head byte by byte without end; return after how many seconds it was closed."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    began_s = time.monotonic()
    writer.write(b"GET /api/health HTTP/1.1\r\nHost: localhost\r\nX-Slow: ")
    try:
        while not stop.is_set() and await _still_open(reader):
            writer.write(b"a")
    except OSError:
        pass
    finally:
        writer.close()
    return time.monotonic() - began_s


async def _still_open(reader: asyncio.StreamReader) -> bool:
    """Return whether the server sends nothing for a second."""
    try:
        async with asyncio.timeout(1.0):
            await reader.read(4096)
    except TimeoutError:
        return True
    return False


@pytest.mark.timeout(120)
def test_five_hundred_slow_clients_delay_no_other(lan: LanServer) -> None:
    """500 connections with endless heads are closed in time while a normal client is served."""
    bare_s, under_s, borne_s = asyncio.run(_attacked(lan))
    p95_bare, p95_under = (float(np.percentile(each, 95)) for each in (bare_s, under_s))
    told = f"{LORISES} slow heads"
    note(23, told, "longest borne (s)", max(borne_s))
    note(23, told, "closed in time", f"{len(borne_s)} of {LORISES}")
    note(
        23,
        told,
        "healthy p95, without and with (ms)",
        f"{1e3 * p95_bare:.1f} and {1e3 * p95_under:.1f}",
    )
    note(23, told, "healthy p95, ratio", p95_under / p95_bare)
    assert len(borne_s) == LORISES
    assert len(under_s) == ASKED


async def _attacked(server: LiveServer) -> tuple[list[float], list[float], list[float]]:
    bare_s = await _healthy(server, ASKED)
    stop = asyncio.Event()
    slow = [asyncio.create_task(_loris(server.port, stop)) for _ in range(LORISES)]
    await asyncio.sleep(0.5)
    under_s = await _healthy(server, ASKED)
    done, late = await asyncio.wait(slow, timeout=HEAD_WITHIN_S + MARGIN_S)
    stop.set()
    await asyncio.gather(*late, return_exceptions=True)
    return bare_s, under_s, [task.result() for task in done]


def _answer_to(port: int, request: bytes, patience_s: float) -> bytes:
    """Send these bytes and return everything received until the server closes."""
    with socket.create_connection(("127.0.0.1", port), timeout=patience_s) as connection:
        connection.sendall(request)
        answer = b""
        while chunk := connection.recv(65536):
            answer += chunk
    return answer


@pytest.mark.timeout(120)
@pytest.mark.long
def test_an_unfinished_request_is_closed(lan: LanServer) -> None:
    """An unfinished head or body gets 408; silence and an unfinished handshake are just closed."""
    head = b"POST /api/login HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
    half_body = head + b"Content-Length: 500\r\n\r\n{"
    half_chunk = head + b"Transfer-Encoding: chunked\r\n\r\n5\r\n{"
    cases = {
        "half a head": (lan.port, head, HEAD_WITHIN_S, b"408"),
        "only line ends": (lan.port, b"\r\n\r\n", HEAD_WITHIN_S, b"408"),
        "silence": (lan.port, b"", HEAD_WITHIN_S, b""),
        "half a body": (lan.port, half_body, BODY_WITHIN_S, b"408"),
        "half a chunk": (lan.port, half_chunk, BODY_WITHIN_S, b"408"),
        "half a head on the help port": (lan.help_port, head, HEAD_WITHIN_S, b"408"),
        "no handshake": (lan.lan_port, b"\x16\x03\x01", HANDSHAKE_WITHIN_S, b""),
    }
    answers = asyncio.run(_all_answers(cases))
    for name, (_, _, _, expected) in cases.items():
        assert answers[name][9:12] == expected, (name, answers[name])


@pytest.mark.timeout(120)
@pytest.mark.long
def test_a_slow_large_upload_is_read_to_its_end(lan: LanServer) -> None:
    """A capture is read to its end at 140 kB/s, even if this exceeds the usual time for a body."""
    with lan.client() as client:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()
        slowly = client.post(
            "/api/captures?name=none.bvh",
            content=_in_pieces(BODY_WITHIN_S + MARGIN_S, 2 * PORTION_BYTES + 500_000),
            timeout=90.0,
        )
    assert slowly.status_code == 422


def _in_pieces(within_s: float, size: int) -> Iterator[bytes]:
    pieces = 100
    for _ in range(pieces):
        time.sleep(within_s / pieces)
        yield b" " * (size // pieces)


async def _all_answers(
    cases: dict[str, tuple[int, bytes, float, bytes]],
) -> dict[str, bytes]:
    asked = [
        asyncio.to_thread(_answer_to, port, request, deadline_s + MARGIN_S)
        for port, request, deadline_s, _ in cases.values()
    ]
    return dict(zip(cases, await asyncio.gather(*asked), strict=True))


def test_an_endless_head_is_refused(lan: LanServer) -> None:
    """A request head of more than 64 KiB gets 431, so that it cannot fill the memory."""
    answer = _answer_to(
        lan.port, b"GET / HTTP/1.1\r\nX-Long: " + b"a" * (MOST_HEAD_BYTES + 1), HEAD_WITHIN_S
    )
    assert answer.startswith(b"HTTP/1.1 431")


def test_a_large_body_in_pieces_is_not_taken_for_a_head(lan: LanServer) -> None:
    """A large body in many segments is not taken for a head, and the connection stays usable."""
    body = b'{"username": "' + b"a" * (3 * MOST_HEAD_BYTES) + b'"}'
    with lan.client() as client:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()
        cookie = f"reembody_login={client.cookies['reembody_login']}"
    connection = HTTPConnection("127.0.0.1", lan.port, timeout=20)
    connection.putrequest("POST", "/api/login")
    connection.putheader("Cookie", cookie)
    connection.putheader("Content-Type", "application/json")
    connection.putheader("Content-Length", str(len(body)))
    connection.endheaders()
    for at in range(0, len(body), 10_000):
        connection.send(body[at : at + 10_000])
        time.sleep(0.005)
    answer = connection.getresponse()
    answer.read()
    assert answer.status == 422
    connection.request("GET", "/api/health")
    assert connection.getresponse().status == 200
    connection.close()


def test_the_oldest_unfinished_request_is_closed_at_the_limit(lan: LanServer) -> None:
    """At the limit of unfinished requests, the oldest is closed and the newest is served."""
    waiting = [
        socket.create_connection(("127.0.0.1", lan.port), timeout=5)
        for _ in range(MOST_UNFINISHED + 20)
    ]
    try:
        with lan.client() as client:
            assert client.get("/api/health").is_success
        waiting[0].settimeout(HEAD_WITHIN_S / 2)
        assert _is_closed(waiting[0])
        waiting[-1].sendall(b"GET /api/health HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")
        assert waiting[-1].recv(65536).startswith(b"HTTP/1.1 200")
    finally:
        for one in waiting:
            one.close()


def _is_closed(connection: socket.socket) -> bool:
    try:
        return connection.recv(1) == b""
    except ConnectionResetError:
        return True
