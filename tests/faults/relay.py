"""A TCP relay on the loopback that emulates a network which can be cut."""

import asyncio
import contextlib
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field

from tests.support.server import free_port


@dataclass
class Relay:
    """Relay bytes in both directions while it is up; `cut()` breaks every connection."""

    target_port: int
    port: int = field(default_factory=free_port)
    up: bool = True
    _writers: set[asyncio.StreamWriter] = field(default_factory=set)
    _tasks: set["asyncio.Task[None]"] = field(default_factory=set)

    @property
    def url(self) -> str:
        """Return the URL at which devices reach the server."""
        return f"http://127.0.0.1:{self.port}"

    def cut(self) -> None:
        """Reset every connection at both ends; new ones are accepted if the relay is up."""
        for writer in tuple(self._writers):
            writer.transport.abort()

    async def idle(self) -> None:
        """Wait until no connection is left."""
        await asyncio.gather(*self._tasks, return_exceptions=True)

    @asynccontextmanager
    async def outage(self) -> AsyncIterator[None]:
        """Reject and cut all connections while the block runs."""
        self.up = False
        self.cut()
        try:
            yield
        finally:
            self.up = True

    async def accept(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Relay one connection, or reset it while the relay is down."""
        if not self.up:
            writer.transport.abort()
            return
        task = asyncio.current_task()
        assert task is not None
        self._tasks.add(task)
        try:
            await self._relay(reader, writer)
        finally:
            self._tasks.discard(task)

    async def _relay(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        far_reader, far_writer = await asyncio.open_connection("127.0.0.1", self.target_port)
        pair = (writer, far_writer)
        self._writers.update(pair)
        ways = (_pass(reader, far_writer), _pass(far_reader, writer))
        tasks = [asyncio.create_task(way) for way in ways]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for one in pair:
                one.transport.abort()
            self._writers.difference_update(pair)
            await asyncio.gather(*tasks, return_exceptions=True)


async def _pass(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    with contextlib.suppress(OSError):
        while data := await reader.read(65536):
            writer.write(data)
            await writer.drain()


@asynccontextmanager
async def relayed(target_port: int) -> AsyncIterator[Relay]:
    """Run a relay in front of a server while the block runs."""
    relay = Relay(target_port)
    server = await asyncio.start_server(relay.accept, "127.0.0.1", relay.port)
    try:
        yield relay
    finally:
        server.close()
        relay.cut()
        await relay.idle()
