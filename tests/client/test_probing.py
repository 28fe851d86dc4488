"""Asking for the clock: what was read is told as it was read, and what never came is null."""

import asyncio
from dataclasses import dataclass, field
from typing import Any, cast

from app.client.telemetry import Prober
from app.wire.messages import CLIENT_MESSAGE, Probe, ProbeAnswer, Probed


@dataclass
class Wire:
    """What the client said."""

    said: list[Any] = field(default_factory=list)

    async def send(self, text: str) -> None:
        """Take a message."""
        self.said.append(CLIENT_MESSAGE.validate_json(text))

    def told(self) -> list[Probed]:
        """The readings among it."""
        return [one for one in self.said if isinstance(one, Probed)]


async def _ask(wire: Wire, prober: Prober, asked: int) -> None:
    """Run until so many probes are out."""
    running = asyncio.create_task(prober.run())
    while sum(isinstance(one, Probe) for one in wire.said) < asked:  # noqa: ASYNC110 - a look
        await asyncio.sleep(0.001)
    running.cancel()
    await asyncio.gather(running, return_exceptions=True)


def test_an_answer_is_told_with_all_four_times() -> None:
    """Nothing is computed: the record holds what the clocks said."""

    async def run() -> list[Probed]:
        wire = Wire()
        prober = Prober(cast("Any", wire), lambda: 5.0, every_s=60.0)
        await _ask(wire, prober, 1)
        answer = ProbeAnswer(client_sent_s=5.0, server_received_ns=7, server_sent_ns=8)
        await prober.take(answer, 5.25)
        return wire.told()

    assert asyncio.run(run()) == [
        Probed(client_sent_s=5.0, server_received_ns=7, server_sent_ns=8, client_received_s=5.25)
    ]


def test_an_answer_that_does_not_come_is_null() -> None:
    """A time-out gives null, and an answer that comes after it changes nothing."""

    async def run() -> list[Probed]:
        wire, ticks = Wire(), iter(range(1000))
        prober = Prober(cast("Any", wire), lambda: float(next(ticks)), every_s=0.02, timeout_s=0.01)
        await _ask(wire, prober, 3)
        late = ProbeAnswer(client_sent_s=0.0, server_received_ns=7, server_sent_ns=8)
        await prober.take(late, 100.0)
        return wire.told()

    told = asyncio.run(run())
    assert [one.client_sent_s for one in told] == [0.0, 1.0]
    assert {
        (one.server_received_ns, one.server_sent_ns, one.client_received_s) for one in told
    } == {(None, None, None)}
