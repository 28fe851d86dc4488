"""Those who are slow on purpose, and those who send too much: they go, everybody else stays."""

import asyncio
import socket
import ssl
import time
from collections.abc import Iterator
from contextlib import contextmanager
from http.client import HTTPConnection

import httpx2
import numpy as np
import psutil
import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from app.lan.deadlines import BODY_WITHIN_S, HEAD_WITHIN_S, MOST_HEAD_BYTES, MOST_UNFINISHED
from app.lan.listening import HANDSHAKE_WITHIN_S
from app.settings import Settings
from app.wire.messages import PROTOCOL_VERSION, SUBPROTOCOL
from tests.faults.figures import note
from tests.faults.streaming import pair_headsets
from tests.faults.test_pressure import watched_memory
from tests.support.lan import LanServer
from tests.support.server import LiveServer

LORISES = 500
MARGIN_S = 5.0
ASKED = 200
MOST_GROWTH_MIB = 64


@pytest.fixture(scope="module")
def lan(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LanServer]:
    """A server with all its doors open."""
    with LanServer(tmp_path_factory.mktemp("slow")) as server:
        yield server


async def _healthy(server: LiveServer, count: int) -> list[float]:
    """How long a client waits for each of `count` answers, in seconds, one after the other."""
    took_s = []
    async with httpx2.AsyncClient(base_url=server.url, timeout=30.0) as client:
        for _ in range(count):
            began_s = time.perf_counter()
            (await client.get("/api/health")).raise_for_status()
            took_s.append(time.perf_counter() - began_s)
            await asyncio.sleep(0.01)
    return took_s


async def _loris(port: int, stop: asyncio.Event) -> float:
    """Send a head byte by byte, never its end; how long the server bore it."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    began_s = time.monotonic()
    try:
        writer.write(b"GET /api/health HTTP/1.1\r\nHost: localhost\r\nX-Slow: ")
        while not stop.is_set():
            writer.write(b"a")
            async with asyncio.timeout(1.0):
                if not await reader.read(4096):
                    break
    except TimeoutError:
        return await _rest(reader, writer, began_s, stop)
    except OSError:
        pass
    finally:
        writer.close()
    return time.monotonic() - began_s


async def _rest(
    reader: asyncio.StreamReader,
    writer: asyncio.StreamWriter,
    began_s: float,
    stop: asyncio.Event,
) -> float:
    """Go on dripping until the server has had enough."""
    while not stop.is_set():
        try:
            writer.write(b"a")
            async with asyncio.timeout(1.0):
                if not await reader.read(4096):
                    break
        except TimeoutError:
            continue
        except OSError:
            break
    return time.monotonic() - began_s


@pytest.mark.timeout(120)
def test_five_hundred_slow_clients_hold_nobody_up(lan: LanServer) -> None:
    """500 connections drip a head: all are closed in time, and a healthy client is answered."""
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
    """Send these bytes and nothing more; everything that comes until the server closes."""
    with socket.create_connection(("127.0.0.1", port), timeout=patience_s) as connection:
        connection.sendall(request)
        answer = b""
        while chunk := connection.recv(65536):
            answer += chunk
    return answer


@pytest.mark.timeout(120)
def test_whoever_owes_a_request_is_told_and_closed(lan: LanServer) -> None:
    """Half a head and half a body get 408, silence and a stuck handshake just an end."""
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


async def _all_answers(
    cases: dict[str, tuple[int, bytes, float, bytes]],
) -> dict[str, bytes]:
    asked = [
        asyncio.to_thread(_answer_to, port, request, deadline_s + MARGIN_S)
        for port, request, deadline_s, _ in cases.values()
    ]
    return dict(zip(cases, await asyncio.gather(*asked), strict=True))


def test_an_endless_head_is_refused(lan: LanServer) -> None:
    """More than 64 KiB of head get 431, so that no memory is filled by a single line."""
    answer = _answer_to(
        lan.port, b"GET / HTTP/1.1\r\nX-Long: " + b"a" * (MOST_HEAD_BYTES + 1), HEAD_WITHIN_S
    )
    assert answer.startswith(b"HTTP/1.1 431")


def test_a_large_body_in_pieces_is_not_mistaken_for_a_head(lan: LanServer) -> None:
    """A body that comes in many segments, and a request after it on the same connection."""
    body = b'{"username": "' + b"a" * (3 * MOST_HEAD_BYTES) + b'"}'
    connection = HTTPConnection("127.0.0.1", lan.port, timeout=20)
    connection.putrequest("POST", "/api/login")
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


def test_the_greediest_makes_room(lan: LanServer) -> None:
    """One more unfinished request than may wait: the oldest goes, the newest is served."""
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


@contextmanager
def _bounded(lan: LanServer, what: str) -> Iterator[None]:
    """Note how much the server's memory grew, and refuse a lot."""
    before = psutil.Process(lan.pid).memory_info().rss
    with watched_memory(lan) as rss:
        yield
        time.sleep(0.2)
    growth_mib = (max(rss) - before) / 2**20
    note(22, what, "server memory, growth at most (MiB)", growth_mib)
    assert growth_mib < MOST_GROWTH_MIB


def test_too_large_a_body_is_refused(lan: LanServer) -> None:
    """Declared or in chunks without a length: 413, before it fills the memory."""
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


def _blocks(mebibytes: int) -> Iterator[bytes]:
    yield from (b" " * 2**20 for _ in range(mebibytes))


def _sent_in_chunks(port: int, mebibytes: int) -> bytes:
    """Send until the server answers, which it does long before the end."""
    with socket.create_connection(("127.0.0.1", port), timeout=30) as connection:
        connection.sendall(
            b"POST /api/login HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
            b"Transfer-Encoding: chunked\r\n\r\n"
        )
        try:
            for block in _blocks(mebibytes):
                connection.sendall(b"%x\r\n" % len(block) + block + b"\r\n")
        except OSError:
            pass
        return connection.recv(65536)


def test_too_large_a_frame_is_refused(lan: LanServer) -> None:
    """1009, and the headset's socket is closed; over ws and wss."""
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
        subprotocols=[SUBPROTOCOL, f"bearer.{token}"],  # type: ignore[list-item]
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
