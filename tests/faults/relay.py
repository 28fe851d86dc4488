"""A TCP relay on the loopback that emulates a network which can be cut."""

import asyncio
import contextlib
import threading
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager
from dataclasses import dataclass, field
from queue import Queue

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
        try:
            far_reader, far_writer = await asyncio.open_connection("127.0.0.1", self.target_port)
        except OSError:  # The server is down.
            writer.transport.abort()
            return
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


class RelayThread:
    """A relay that runs in a thread of its own, for tests that are not asynchronous themselves."""

    def __init__(self, relay: Relay, loop: asyncio.AbstractEventLoop) -> None:
        self._relay, self._loop = relay, loop

    @property
    def url(self) -> str:
        """Return the URL at which browsers reach the server; they treat the name as secure."""
        return f"http://localhost:{self._relay.port}"

    @contextmanager
    def outage(self) -> Iterator[None]:
        """Reject and cut all connections while the block runs."""
        self._loop.call_soon_threadsafe(self._set, False)
        try:
            yield
        finally:
            self._loop.call_soon_threadsafe(self._set, True)

    def _set(self, up: bool) -> None:  # noqa: FBT001 - passed on by the loop
        self._relay.up = up
        if not up:
            self._relay.cut()


@contextmanager
def relayed_in_thread(target_port: int) -> Iterator[RelayThread]:
    """Run a relay in front of a server in a thread while the block runs."""
    ready: Queue[tuple[RelayThread, asyncio.Event]] = Queue()

    async def run() -> None:
        async with relayed(target_port) as relay:
            over = asyncio.Event()
            ready.put((RelayThread(relay, asyncio.get_running_loop()), over))
            await over.wait()

    thread = threading.Thread(target=asyncio.run, args=(run(),), daemon=True)
    thread.start()
    relay, over = ready.get(timeout=10.0)
    try:
        yield relay
    finally:
        relay._loop.call_soon_threadsafe(over.set)
        thread.join(timeout=10.0)


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
