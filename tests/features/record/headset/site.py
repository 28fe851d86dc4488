"""A real server with an operator, and headsets that connect to it by real sockets."""

import json
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import httpx2
from websockets.sync.client import ClientConnection, connect

from app.database import Database, open_database
from tests.features.lab import STUDY, Json, ok
from tests.support.server import ADMIN_PASSWORD, LiveServer

SUBPROTOCOL = "reembody.v1"
HELLO: Json = {"type": "hello", "protocol": 1, "client": "test"}


@dataclass
class Headset:
    """An open headset socket; `heard` has every message that it received."""

    socket: ClientConnection
    welcome: Json = field(default_factory=dict)
    heard: list[Json] = field(default_factory=list)
    next_report: int = 0

    @property
    def epoch(self) -> int:
        """The epoch of this run of the client."""
        return int(self.welcome["epoch"])

    def say(self, message: Json | bytes) -> None:
        """Send a JSON message or a batch."""
        self.socket.send(message if isinstance(message, bytes) else json.dumps(message))

    def hear(self, kind: str, matching: Callable[[Json], bool] = lambda _: True) -> Json:
        """Return the next message of a kind that matches; fail after 10 s without a message."""
        while True:
            message: Json = json.loads(self.socket.recv(timeout=10.0))
            self.heard.append(message)
            if message["type"] == kind and matching(message):
                return message

    def hear_any(self, kinds: tuple[str, ...]) -> Json:
        """Return the next message of any of these kinds."""
        while True:
            message: Json = json.loads(self.socket.recv(timeout=10.0))
            self.heard.append(message)
            if message["type"] in kinds:
                return message

    def acknowledged(self, stream: str, next_seq: int) -> Json:
        """Wait until every `seq < next_seq` of a stream is acknowledged."""

        def matches(ack: Json) -> bool:
            return {"stream": stream, "epoch": self.epoch, "next_seq": next_seq} in ack["positions"]

        return self.hear("ack", matches)

    def report(self, **body: Any) -> None:
        """Send a report with the next seq."""
        seq, self.next_report = self.next_report, self.next_report + 1
        self.say({"type": "report", "epoch": self.epoch, "seq": seq, "body": body})

    def reported(self, **body: Any) -> None:
        """Send a report and wait until it is on disk."""
        self.report(**body)
        self.acknowledged("reports", self.next_report)


@dataclass(frozen=True)
class Site:
    """A server, its operator's HTTP client, and direct access to its database."""

    server: LiveServer
    operator: httpx2.Client
    database: Database

    def join(self, **fields: Any) -> str:
        """Create a session and return its id."""
        view = ok(self.operator.post(f"/api/studies/{STUDY}/sessions", json=fields))
        return str(view["id"])

    def view(self, session_id: str) -> Json:
        """Return the current state of a session."""
        view: Json = ok(self.operator.get(f"/api/sessions/{session_id}"))
        return view

    def command(self, session_id: str, kind: str, **fields: Any) -> Json:
        """Send a command that must be accepted and return the session after it."""
        body = {
            "command_id": str(uuid.uuid4()),
            "expected_version": self.view(session_id)["version"],
            "type": kind,
            **fields,
        }
        view: Json = ok(self.operator.post(f"/api/sessions/{session_id}/commands", json=body))
        return view

    def skip_to(self, session_id: str, step_key: str) -> None:
        """Start a session and skip every step before `step_key`."""
        view = self.command(session_id, "start")
        while view["steps"][view["current"]["index"]]["key"] != step_key:
            view = self.command(session_id, "skip", reason="not in this test")

    def token(self, session_id: str) -> str:
        """Pair a headset with a session and return its token."""
        path = f"/api/sessions/{session_id}/pairings"
        code = ok(self.operator.post(path, json={"device": "headset"}))["code"]
        with self.server.client() as device:
            return str(ok(device.post("/api/devices/pair", json={"code": code}))["token"])

    @contextmanager
    def socket(self, token: str | None, **arguments: Any) -> Iterator[ClientConnection]:
        """Open a headset socket that has not sent its hello."""
        bearer = [] if token is None else [f"bearer.{token}"]
        url = self.server.url.replace("http", "ws") + "/api/vr/stream"
        offered: Any = [SUBPROTOCOL, *bearer]
        with connect(url, subprotocols=offered, compression=None, **arguments) as socket:
            yield socket

    @contextmanager
    def headset(self, token: str, epoch: int | None = None, **hello: Any) -> Iterator[Headset]:
        """Open a headset socket that has sent its hello and been welcomed."""
        with self.socket(token) as socket:
            headset = Headset(socket)
            headset.say({**HELLO, "epoch": epoch, **hello})
            headset.welcome = headset.hear("welcome")
            yield headset


@contextmanager
def open_site(server: LiveServer) -> Iterator[Site]:
    """Yield a running server on its SQLite database, with its operator signed in."""
    with server.client() as operator:
        ok(operator.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        database = open_database(f"sqlite:///{server.data_dir / 'reembody.sqlite'}")
        try:
            yield Site(server, operator, database)
        finally:
            database.close()
