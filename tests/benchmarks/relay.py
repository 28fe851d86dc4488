"""A bare relay: a process that passes each datagram on to a WebSocket and does nothing else."""

import asyncio
import multiprocessing
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from websockets.asyncio.server import serve
from websockets.sync.client import connect

from tests.support.datagrams import HERE
from tests.support.server import free_port


@contextmanager
def relay(udp_port: int) -> Iterator[str]:
    """Run the bare relay in a process of its own; yield the address of its WebSocket."""
    port = free_port()
    process = multiprocessing.get_context("spawn").Process(
        target=_run_relay, args=(udp_port, port), daemon=True
    )
    process.start()
    try:
        yield f"ws://127.0.0.1:{port}"
    finally:
        process.terminate()
        process.join()


def _run_relay(udp_port: int, port: int) -> None:
    asyncio.run(_relaying(udp_port, port))


async def _relaying(udp_port: int, port: int) -> None:
    queues: set[asyncio.Queue[bytes]] = set()

    class Incoming(asyncio.DatagramProtocol):
        def datagram_received(self, data: bytes, _addr: object) -> None:
            for queue in queues:
                queue.put_nowait(data)

    async def serve_one(viewer: Any) -> None:
        queue: asyncio.Queue[bytes] = asyncio.Queue()
        queues.add(queue)
        while True:
            await viewer.send(await queue.get())

    loop = asyncio.get_running_loop()
    await loop.create_datagram_endpoint(Incoming, local_addr=(HERE, udp_port))
    async with serve(serve_one, HERE, port, compression=None):
        await asyncio.Event().wait()


def connected(url: str) -> Any:
    """Connect to the relay as soon as it is there."""
    deadline = time.monotonic() + 180
    while True:
        try:
            return connect(url, compression=None)
        except OSError:
            if time.monotonic() > deadline:
                raise
            time.sleep(0.1)
