"""Asking for the server's clock again and again, and telling the raw reading of each exchange."""

import asyncio
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from websockets.asyncio.client import ClientConnection

from app.wire.messages import Probe, ProbeAnswer, Probed

TIMEOUT_S = 2.0


@dataclass
class Prober:
    """The exchanges of one connection. `monotonic_s` is the client's own clock.

    An answer that does not come within `timeout_s` is told as null, never as a number; when it
    comes after all, it is ignored.
    """

    socket: ClientConnection
    monotonic_s: Callable[[], float]
    every_s: float
    timeout_s: float = TIMEOUT_S
    _asked: dict[float, float] = field(default_factory=dict)

    async def run(self) -> None:
        """Ask until cancelled."""
        while True:
            await self._give_up()
            client_sent_s = self.monotonic_s()
            self._asked[client_sent_s] = time.monotonic()
            await self.socket.send(Probe(client_sent_s=client_sent_s).model_dump_json())
            await asyncio.sleep(self.every_s)

    async def take(self, answer: ProbeAnswer, received_s: float) -> None:
        """Tell the four times of an exchange, as they were read."""
        if self._asked.pop(answer.client_sent_s, None) is None:
            return
        await self._tell(
            Probed(
                client_sent_s=answer.client_sent_s,
                server_received_ns=answer.server_received_ns,
                server_sent_ns=answer.server_sent_ns,
                client_received_s=received_s,
            )
        )

    async def _give_up(self) -> None:
        before_s = time.monotonic() - self.timeout_s
        for client_sent_s in [sent for sent, at_s in self._asked.items() if at_s <= before_s]:
            del self._asked[client_sent_s]
            await self._tell(
                Probed(
                    client_sent_s=client_sent_s,
                    server_received_ns=None,
                    server_sent_ns=None,
                    client_received_s=None,
                )
            )

    async def _tell(self, reading: Probed) -> None:
        await self.socket.send(reading.model_dump_json())
