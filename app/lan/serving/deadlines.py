"""How long a client may take to say what it wants: a deadline for the head, one for the body.

uvicorn keeps a connection whose request never ends for as long as the client likes; a few hundred
of those (a "slow loris", or tablets that left the room in mid-sentence) would hold sockets until
none is left. The deadlines count from the first byte that was due, however many more drip in; a
large body that somebody takes has the body's for every portion of it.
Requests that are not all there are also counted: above `MOST_UNFINISHED` the oldest of whoever has
most makes room, so that the slow are shut out before anybody else is.
"""

import asyncio
from collections import Counter
from collections.abc import Callable
from http import HTTPStatus
from typing import Any

from uvicorn.config import Config
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol
from uvicorn.server import ServerState

from app.lan.network import STRANGER

HEAD_WITHIN_S = 10.0
BODY_WITHIN_S = 30.0
PORTION_BYTES = 2 * 1024 * 1024
"""Usual bodies have one portion at most: this asks for 70 kB/s of the slowest tablet."""
MOST_HEAD_BYTES = 64 * 1024
MOST_UNFINISHED = 256
CLOSED_WITHIN_S = 2.0
READS_ANSWER_WITHIN_S = 0.5
"""A stranger whose body was answered before its end: nothing more of it is read. Whoever the lab
knows may send the rest, since a browser shows the answer only then."""


class Unfinished:
    """The connections that owe the rest of a request, oldest first."""

    def __init__(self, most: int = MOST_UNFINISHED) -> None:
        self._most = most
        self._connections: dict[ReceivingProtocol, str] = {}

    def __len__(self) -> int:
        return len(self._connections)

    def add(self, connection: "ReceivingProtocol", address: str) -> None:
        """One more; above the limit the greediest address loses its oldest."""
        self._connections.setdefault(connection, address)
        if len(self._connections) <= self._most:
            return
        ((greediest, _),) = Counter(self._connections.values()).most_common(1)
        oldest = next(one for one, owner in self._connections.items() if owner == greediest)
        self.discard(oldest)
        oldest.give_up()

    def discard(self, connection: "ReceivingProtocol") -> None:
        """This one owes nothing any more."""
        self._connections.pop(connection, None)


class ReceivingProtocol(HttpToolsProtocol):
    """uvicorn's HTTP protocol with deadlines for what it receives."""

    def __init__(
        self,
        config: Config,
        server_state: ServerState,
        app_state: dict[str, Any],
        unfinished: Unfinished,
    ) -> None:
        super().__init__(config, server_state, app_state, asyncio.get_running_loop())
        self._unfinished = unfinished
        self._timer: asyncio.TimerHandle | None = None
        self._heads = 0
        self._head_bytes = 0
        self._in_body = False
        self._portion = 0

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]  # asyncio hands a Transport
        """The head is due from now on."""
        super().connection_made(transport)
        self._await_head()

    def connection_lost(self, exc: Exception | None) -> None:
        """Nothing is due any more."""
        self._settle()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Parse; the next head is due from its first byte, or from what only looks like one."""
        if self._timer is None:
            self._await_head()
        heads, in_body = self._heads, self._in_body
        super().data_received(data)
        if heads == self._heads and not in_body:
            self._head_bytes += len(data)
            if self._head_bytes > MOST_HEAD_BYTES:
                self._refuse(HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE)

    def on_message_begin(self) -> None:
        """A head begins."""
        super().on_message_begin()
        if self._timer is None:
            self._await_head()

    def on_headers_complete(self) -> None:
        """The head is there; the body is due."""
        self._settle()
        self._heads, self._head_bytes, self._in_body = self._heads + 1, 0, True
        self._portion = 0
        self._await(BODY_WITHIN_S, self._body_is_late)
        super().on_headers_complete()

    def on_body(self, body: bytes) -> None:
        """A portion that came in time earns time for the next, unless it was answered already."""
        super().on_body(body)
        self._portion += len(body)
        if self._portion >= PORTION_BYTES and self._answering:
            self._portion = 0
            self._settle()
            self._await(BODY_WITHIN_S, self._body_is_late)

    def on_response_complete(self) -> None:
        """Go on with the next request, unless a stranger was refused in mid-sentence."""
        if self._in_body and STRANGER in self.scope and not self.transport.is_closing():
            self._settle()
            # Closed at once, the answer might be lost on the way to those who still send.
            self.flow.pause_reading()
            self.cycle.body = bytearray()
            self.loop.call_later(READS_ANSWER_WITHIN_S, self.transport.abort)
            return
        super().on_response_complete()

    def on_message_complete(self) -> None:
        """All of it is there."""
        self._settle()
        self._in_body = False
        super().on_message_complete()

    def handle_websocket_upgrade(self) -> None:
        """What follows are messages, which have rules of their own."""
        self._settle()
        super().handle_websocket_upgrade()

    def give_up(self) -> None:
        """Make room at once."""
        self._settle()
        self.transport.abort()

    def _await_head(self) -> None:
        self._await(HEAD_WITHIN_S, self._head_is_late)

    def _await(self, within_s: float, late: Callable[[], None]) -> None:
        self._timer = self.loop.call_later(within_s, late)
        self._unfinished.add(self, self.client[0] if self.client else "")

    def _settle(self) -> None:
        self._unfinished.discard(self)
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _head_is_late(self) -> None:
        self._settle()
        if self._answering:
            # Bytes of a next request came while this one is answered: it may take its time.
            self._await_head()
        elif self._head_bytes:
            self._refuse(HTTPStatus.REQUEST_TIMEOUT)
        else:
            self._close()

    def _body_is_late(self) -> None:
        # Whoever waits for the body in the application hears that the client is gone.
        self._refuse(HTTPStatus.REQUEST_TIMEOUT)

    @property
    def _answering(self) -> bool:
        return self.cycle is not None and not self.cycle.response_complete

    def _refuse(self, status: HTTPStatus) -> None:
        self._settle()
        # Words in the middle of an answer, or after it, would be taken for part of the next one.
        begun = self.cycle is not None and self.cycle.response_started
        silent = begun and (self._in_body or self._answering)
        if not silent and not self.transport.is_closing():
            self.transport.write(
                f"HTTP/1.1 {status.value} {status.phrase}\r\n"
                "content-length: 0\r\nconnection: close\r\n\r\n".encode("ascii")
            )
        self._close()

    def _close(self) -> None:
        """Close, and do not wait for ever for a client that does not read the last bytes."""
        self.transport.close()
        self.loop.call_later(CLOSED_WITHIN_S, self.transport.abort)
