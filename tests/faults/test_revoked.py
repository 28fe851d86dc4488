"""Tests that the end of a login or pairing immediately closes its streams (fault 31)."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial

import httpx2
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from app.wire.messages import SUBPROTOCOL
from tests.faults.figures import note
from tests.features.lab import STUDY
from tests.support.server import ADMIN_PASSWORD, LiveServer

NOTICED_WITHIN_S = 30.0


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    """Provide a server that is started as operators start it."""
    with LiveServer(tmp_path_factory.mktemp("revoked")) as server:
        yield server


@dataclass
class Reader:
    """A client with an open stream, read in a thread; `ended_s` is the time at which it ended."""

    client: httpx2.Client
    path: str
    began: threading.Event = field(default_factory=threading.Event)
    ended: threading.Event = field(default_factory=threading.Event)
    ended_s: float = 0.0

    def read(self) -> None:
        """Read until the server ends the stream."""
        with self.client.stream("GET", self.path, timeout=None) as answer:
            for _ in answer.iter_bytes():
                self.began.set()
        self.ended_s = time.monotonic()
        self.ended.set()


@contextmanager
def reading(client: httpx2.Client, path: str) -> Iterator[Reader]:
    """Yield a reader with an open stream."""
    reader = Reader(client, path)
    threading.Thread(target=reader.read, daemon=True).start()
    assert reader.began.wait(NOTICED_WITHIN_S)
    yield reader


@contextmanager
def signed_in(server: LiveServer) -> Iterator[httpx2.Client]:
    """Yield a client with its own login."""
    with server.client() as client:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()
        yield client


def joined(client: httpx2.Client) -> str:
    """Create a session and return its id."""
    answer = client.post(f"/api/studies/{STUDY}/sessions", json={"kind": "test"})
    return str(answer.raise_for_status().json()["id"])


def code(client: httpx2.Client, session_id: str, device: str) -> str:
    """Return a new pairing code for a session."""
    path = f"/api/sessions/{session_id}/pairings"
    return str(client.post(path, json={"device": device}).raise_for_status().json()["code"])


def shut_out_after_s(reader: Reader, end: Callable[[], object]) -> float:
    """Call `end` and return how many seconds later the stream was closed."""
    before_s = time.monotonic()
    end()
    assert reader.ended.wait(NOTICED_WITHIN_S), "the stream went on"
    return reader.ended_s - before_s


def test_ending_a_login_closes_its_streams(server: LiveServer) -> None:
    """Logging out, or an admin ending logins, closes a live stream, and later requests get 401."""
    with signed_in(server) as admin:
        session_id = joined(admin)
        path = f"/api/sessions/{session_id}/live"
        own_id = admin.get("/api/me").json()["account"]["id"]
        ways: dict[str, Callable[[httpx2.Client], object]] = {
            "logged out": lambda client: client.post("/api/logout"),
            "logins ended by an admin": lambda _: admin.delete(f"/api/accounts/{own_id}/logins"),
        }
        for way, end in ways.items():
            with signed_in(server) as client, reading(client, path) as reader:
                took_s = shut_out_after_s(reader, partial(end, client))
                assert client.get(path.removesuffix("/live")).status_code == 401
            note(31, "login ended", f"{way}: stream closed after, s", took_s)


def test_unpairing_a_tablet_closes_its_stream(server: LiveServer) -> None:
    """Unpairing a tablet closes its stream, and its next request gets 401."""
    with signed_in(server) as admin, server.client() as tablet:
        session_id = joined(admin)
        tablet.post("/api/devices/pair", json={"code": code(admin, session_id, "tablet")})
        device = admin.get(f"/api/sessions/{session_id}").json()["devices"][0]["id"]
        with reading(tablet, "/api/tablet/live") as reader:
            took_s = shut_out_after_s(
                reader, lambda: admin.delete(f"/api/sessions/{session_id}/devices/{device}")
            )
        assert tablet.get("/api/tablet/state").status_code == 401
    note(31, "pairing ended", "tablet's stream closed after, s", took_s)


def test_a_headset_that_is_replaced_is_closed_with_the_reason(server: LiveServer) -> None:
    """A replaced headset's socket is closed with code 4401, and the new one continues."""
    with signed_in(server) as admin, server.client() as other:
        session_id = joined(admin)
        pair = {"code": code(admin, session_id, "headset")}
        token = other.post("/api/devices/pair", json=pair).raise_for_status().json()["token"]
        url = f"{server.url.replace('http', 'ws')}/api/vr/stream"
        offered = [SUBPROTOCOL, f"bearer.{token}"]
        with connect(url, subprotocols=offered) as socket:  # type: ignore[arg-type]  # a token is a plain str
            socket.send('{"type":"hello","protocol":1,"client":"test","epoch":null}')
            socket.recv(timeout=NOTICED_WITHIN_S)
            began_s = time.monotonic()
            again = {"code": code(admin, session_id, "headset")}
            other.post("/api/devices/pair", json=again).raise_for_status()
            reason = closing_code(socket)
        note(31, "pairing ended", "headset's socket closed after, s", time.monotonic() - began_s)
        assert reason == 4401


def closing_code(socket: ClientConnection) -> int | None:
    """Read until the server closes the socket and return the close code."""
    try:
        while True:
            socket.recv(timeout=NOTICED_WITHIN_S)
    except ConnectionClosed as closed:
        return None if closed.rcvd is None else closed.rcvd.code
