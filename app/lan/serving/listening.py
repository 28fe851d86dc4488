"""Serve one application on several listeners ("doors") in one event loop.

A door is a set of bound sockets, the application behind them, and a TLS context if it is encrypted.
uvicorn's own `Server` supports one application and one socket configuration; this one runs the
application's lifespan once and lets all doors share connections, tasks and shutdown.
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
    """A listener: bound sockets and the application behind them; `tls` None means plain http."""

    sockets: tuple[socket.socket, ...]
    config: uvicorn.Config
    tls: ssl.SSLContext | None = None


class SocketProtocol(WebSocketsSansIOProtocol):
    """A WebSocket protocol that also ends a handshake when it is refused with a response.

    uvicorn does so for `websocket.close`, but not for a refusal with a body
    (`websocket.http.response.body`): it would log an error for each, with which anybody could fill
    a disk.
    """

    async def send(self, message: Any) -> None:
        """Send a message of the application, and end a refused handshake."""
        await super().send(message)
        if self.initial_response is not None and self.close_sent:
            self.handshake_complete = True


class LabServer(uvicorn.Server):
    """Serves the first door's application and its lifespan; `meanwhile` runs alongside."""

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
        """Serve until the server is stopped."""
        task = asyncio.ensure_future(self._meanwhile())
        try:
            await super().main_loop()
        finally:
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)

    def _protocol_of(self, door: Door) -> Callable[[], asyncio.Protocol]:
        state = self.lifespan.state if door is self._doors[0] or door.tls else {}
        return lambda: ReceivingProtocol(door.config, self.server_state, state, self._unfinished)


def bind(hosts: Sequence[str], port: int, option: str) -> tuple[socket.socket, ...]:
    """Bind sockets to `port` at every one of `hosts`; IPv6 is skipped if it is unavailable.

    For the port 0 the operating system chooses a free one, which is then that of all hosts. Raises
    InvalidInput, naming the `option` that selects another port, if the port is taken.
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
                remedy=f"Stop the program that uses it, or choose another port with {option}",
            ) from error
        port = port_of(bound)
    return tuple(bound)


def port_of(sockets: Sequence[socket.socket]) -> int:
    """Return the port to which sockets of one door are bound."""
    port: int = sockets[0].getsockname()[1]
    return port


def tls_context() -> ssl.SSLContext:
    """Return a TLS context without a certificate.

    It allows TLS 1.2 and newer, with the ciphers that the library recommends.
    """
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    # A renegotiation costs the server ten times as much as the client.
    context.options |= ssl.OP_NO_RENEGOTIATION | ssl.OP_NO_COMPRESSION
    return context


def allow_open_files() -> None:
    """Raise the process's limit of open files as far as the system allows without privileges."""
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
