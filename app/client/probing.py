"""Asking for the server's clock again and again, and telling the raw reading of each exchange."""

import asyncio
from collections.abc import Callable

from websockets.asyncio.client import ClientConnection

from app.wire.messages import Probe, ProbeAnswer, Probed


async def probe_forever(
    socket: ClientConnection, monotonic_s: Callable[[], float], every_s: float
) -> None:
    """Send a probe every so many seconds; `monotonic_s` is the client's own clock."""
    while True:
        await socket.send(Probe(client_sent_s=monotonic_s()).model_dump_json())
        await asyncio.sleep(every_s)


def probed(answer: ProbeAnswer, received_s: float) -> Probed:
    """The four times of one exchange, as they were read."""
    return Probed(
        client_sent_s=answer.client_sent_s,
        server_received_ns=answer.server_received_ns,
        server_sent_ns=answer.server_sent_ns,
        client_received_s=received_s,
    )
