"""Limit how long a client may take to send a request: a deadline for the head, one for the body.

uvicorn keeps a connection with an unfinished request as long as the client likes; a few hundred of
those (a "slow loris", or tablets that left the room while sending) would occupy sockets until none
is left. The deadlines count from the first expected byte, however many more trickle in; a large
body that the application reads has a separate deadline for each portion.

Unfinished requests are also counted: above `MOST_UNFINISHED`, the address with the most loses its
oldest one, so that slow clients are shut out before others.
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
"""Bytes of a body per deadline; requires 70 kB/s. Most bodies have one portion."""
MOST_HEAD_BYTES = 64 * 1024
MOST_UNFINISHED = 256
CLOSED_WITHIN_S = 2.0
READS_ANSWER_WITHIN_S = 0.5
"""The time for a stranger to read a response that was sent before the end of the body, of which
nothing more is read. Other clients may send the rest: browsers show the response only then."""


class Unfinished:
    """The connections with an unfinished request, oldest first."""

    def __init__(self, most: int = MOST_UNFINISHED) -> None:
        self._most = most
        self._connections: dict[ReceivingProtocol, str] = {}

    def __len__(self) -> int:
        return len(self._connections)

    def add(self, connection: "ReceivingProtocol", address: str) -> None:
        """Add a connection; above the limit, the address with the most loses its oldest one."""
        self._connections.setdefault(connection, address)
        if len(self._connections) <= self._most:
            return
        ((greediest, _),) = Counter(self._connections.values()).most_common(1)
        oldest = next(one for one, owner in self._connections.items() if owner == greediest)
        self.discard(oldest)
        oldest.give_up()

    def discard(self, connection: "ReceivingProtocol") -> None:
        """Remove a connection, whose request is complete."""
        self._connections.pop(connection, None)


class ReceivingProtocol(HttpToolsProtocol):
    """The HTTP protocol of uvicorn, with deadlines for receiving requests."""

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
        """Start the deadline of the first head."""
        super().connection_made(transport)
        self._await_head()

    def connection_lost(self, exc: Exception | None) -> None:
        """Cancel the deadline."""
        self._settle()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Parse data.

        The first byte of the next head, or of other data in its place, starts its deadline.
        """
        if self._timer is None:
            self._await_head()
        heads, in_body = self._heads, self._in_body
        super().data_received(data)
        if heads == self._heads and not in_body:
            self._head_bytes += len(data)
            if self._head_bytes > MOST_HEAD_BYTES:
                self._refuse(HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE)

    def on_message_begin(self) -> None:
        """Start the deadline of a head, unless one is running."""
        super().on_message_begin()
        if self._timer is None:
            self._await_head()

    def on_headers_complete(self) -> None:
        """Start the deadline of the body, since the head is complete."""
        self._settle()
        self._heads, self._head_bytes, self._in_body = self._heads + 1, 0, True
        self._portion = 0
        self._await(BODY_WITHIN_S, self._body_is_late)
        super().on_headers_complete()

    def on_body(self, body: bytes) -> None:
        """Extend the deadline after each portion, unless the response was already sent."""
        super().on_body(body)
        self._portion += len(body)
        if self._portion >= PORTION_BYTES and self._answering:
            self._portion = 0
            self._settle()
            self._await(BODY_WITHIN_S, self._body_is_late)

    def on_response_complete(self) -> None:
        """Continue with the next request, unless a stranger was refused in mid-body."""
        if self._in_body and STRANGER in self.scope and not self.transport.is_closing():
            self._settle()
            # Closing immediately might lose the response on the way to a client that still sends.
            self.flow.pause_reading()
            self.cycle.body = bytearray()
            self.loop.call_later(READS_ANSWER_WITHIN_S, self.transport.abort)
            return
        super().on_response_complete()

    def on_message_complete(self) -> None:
        """Cancel the deadline, since the request is complete."""
        self._settle()
        self._in_body = False
        super().on_message_complete()

    def handle_websocket_upgrade(self) -> None:
        """Cancel the deadline: WebSocket messages have their own limits."""
        self._settle()
        super().handle_websocket_upgrade()

    def give_up(self) -> None:
        """Abort the connection immediately."""
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
            # Bytes of the next request arrived before this response is complete, which may take
            # longer.
            self._await_head()
        elif self._head_bytes:
            self._refuse(HTTPStatus.REQUEST_TIMEOUT)
        else:
            self._close()

    def _body_is_late(self) -> None:
        # Code that waits for the body in the application is notified of the disconnect.
        self._refuse(HTTPStatus.REQUEST_TIMEOUT)

    @property
    def _answering(self) -> bool:
        return self.cycle is not None and not self.cycle.response_complete

    def _refuse(self, status: HTTPStatus) -> None:
        self._settle()
        # Within or after a response, these bytes would be taken for part of it or the next one.
        started = self.cycle is not None and self.cycle.response_started
        silent = started and (self._in_body or self._answering)
        if not silent and not self.transport.is_closing():
            self.transport.write(
                f"HTTP/1.1 {status.value} {status.phrase}\r\n"
                "content-length: 0\r\nconnection: close\r\n\r\n".encode("ascii")
            )
        self._close()

    def _close(self) -> None:
        """Close the connection, with a time limit for a client that does not read the rest."""
        self.transport.close()
        self.loop.call_later(CLOSED_WITHIN_S, self.transport.abort)
