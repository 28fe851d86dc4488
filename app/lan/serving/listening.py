"""One application behind several doors, in one event loop.

A door is a set of bound sockets, what is served behind them, and the TLS context if it is locked.
uvicorn's own `Server` knows one application and one socket configuration; this one starts the
application's lifespan once and lets every door share its connections, its tasks and its end.
"""

import asyncio
import socket
import ssl
import sys
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass
from typing import Any

import uvicorn
from uvicorn.config import STARTUP_FAILURE
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from app.errors import InvalidInput
from app.lan.serving.deadlines import ReceivingProtocol, Unfinished

HANDSHAKE_WITHIN_S = 10.0
MOST_OPEN_FILES = 8192


@dataclass(frozen=True)
class Door:
    """Bound sockets and what is behind them; `tls` None means plain http."""

    sockets: tuple[socket.socket, ...]
    config: uvicorn.Config
    tls: ssl.SSLContext | None = None


class SocketProtocol(WebSocketsSansIOProtocol):
    """A WebSocket whose handshake is over, too, once it was answered with a refusal.

    uvicorn knows that of `websocket.close`, but not of a refusal with a body
    (`websocket.http.response.body`): it would log an error for each, and anybody could fill a disk.
    """

    async def send(self, message: Any) -> None:
        """As the application wishes."""
        await super().send(message)
        if self.initial_response is not None and self.close_sent:
            self.handshake_complete = True


class LabServer(uvicorn.Server):
    """Serves the first door's application and its lifespan; `meanwhile` runs beside it."""

    def __init__(self, doors: Sequence[Door], meanwhile: Callable[[], Awaitable[None]]) -> None:
        super().__init__(doors[0].config)
        self._doors, self._meanwhile = tuple(doors), meanwhile
        self._unfinished = Unfinished()

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:  # noqa: ARG002 - uvicorn's signature
        """Start the application, then open every door."""
        await self.lifespan.startup()
        if self.lifespan.should_exit:
            sys.exit(STARTUP_FAILURE)
        self.servers = []
        loop = asyncio.get_running_loop()
        for door in self._doors:
            if not door.config.loaded:
                door.config.load()
            for one in door.sockets:
                opened = await loop.create_server(
                    self._protocol_of(door),
                    sock=one,
                    ssl=door.tls,
                    ssl_handshake_timeout=HANDSHAKE_WITHIN_S if door.tls else None,
                    backlog=door.config.backlog,
                )
                self.servers.append(opened)
        self.started = True

    async def main_loop(self) -> None:
        """Until somebody ends it."""
        beside = asyncio.ensure_future(self._meanwhile())
        try:
            await super().main_loop()
        finally:
            beside.cancel()
            await asyncio.gather(beside, return_exceptions=True)

    def _protocol_of(self, door: Door) -> Callable[[], asyncio.Protocol]:
        state = self.lifespan.state if door is self._doors[0] or door.tls else {}
        return lambda: ReceivingProtocol(door.config, self.server_state, state, self._unfinished)


def bind(hosts: Sequence[str], port: int, option: str) -> tuple[socket.socket, ...]:
    """Sockets for `port` at every one of `hosts`; IPv6 is left out where there is none.

    Raises InvalidInput, naming the `option` that chooses another port, where it is taken.
    """
    bound: list[socket.socket] = []
    for host in hosts:
        try:
            bound.append(_bind_one(host, port))
        except OSError as error:
            if host == "::" and bound:
                continue
            for one in bound:
                one.close()
            raise InvalidInput(
                f"port {port} at {host} cannot be opened: {error.strerror}",
                value=port,
                remedy=f"End what uses it, or choose another port with {option}",
            ) from error
    return tuple(bound)


def tls_context() -> ssl.SSLContext:
    """TLS 1.2 and newer, with the ciphers the library recommends; it has no certificate yet."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    # A renegotiation costs the server ten times what it costs whoever asks for it.
    context.options |= ssl.OP_NO_RENEGOTIATION | ssl.OP_NO_COMPRESSION
    return context


def allow_open_files() -> None:
    """Let the process hold as many sockets as the system grants without asking."""
    if sys.platform == "win32":
        return
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    most = MOST_OPEN_FILES if hard == resource.RLIM_INFINITY else min(hard, MOST_OPEN_FILES)
    if soft < most:
        resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))


def _bind_one(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    made = socket.socket(family, socket.SOCK_STREAM)
    try:
        if sys.platform != "win32":
            made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if family == socket.AF_INET6:
            made.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 1)
        made.bind((host, port))
    except OSError:
        made.close()
        raise
    made.setblocking(False)
    return made
