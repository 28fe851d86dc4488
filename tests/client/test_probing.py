"""Tests of the client's clock probes: readings are reported unchanged, missing ones as null."""

import asyncio
from dataclasses import dataclass, field
from typing import Any, cast

from app.client.telemetry import Prober
from app.wire.messages import CLIENT_MESSAGE, Probe, ProbeAnswer, Probed


@dataclass
class Wire:
    """A connection that records what the client sends."""

    sent: list[Any] = field(default_factory=list)

    async def send(self, text: str) -> None:
        """Record a message."""
        self.sent.append(CLIENT_MESSAGE.validate_json(text))

    def readings(self) -> list[Probed]:
        """Return the clock readings among the messages."""
        return [one for one in self.sent if isinstance(one, Probed)]


async def _run_probes(wire: Wire, prober: Prober, requested: int) -> None:
    """Run the prober until this many probes were sent."""
    running = asyncio.create_task(prober.run())
    while sum(isinstance(one, Probe) for one in wire.sent) < requested:  # noqa: ASYNC110 - it has no event
        await asyncio.sleep(0.001)
    running.cancel()
    await asyncio.gather(running, return_exceptions=True)


def test_a_reply_is_reported_with_all_four_times() -> None:
    """A reply is reported with all four clock readings, unchanged."""

    async def run() -> list[Probed]:
        wire = Wire()
        prober = Prober(cast("Any", wire), lambda: 5.0, every_s=60.0)
        await _run_probes(wire, prober, 1)
        answer = ProbeAnswer(client_sent_s=5.0, server_received_ns=7, server_sent_ns=8)
        await prober.take(answer, 5.25)
        return wire.readings()

    assert asyncio.run(run()) == [
        Probed(client_sent_s=5.0, server_received_ns=7, server_sent_ns=8, client_received_s=5.25)
    ]


def test_a_missing_reply_is_reported_as_null() -> None:
    """A probe that times out is reported with null, and its late reply is ignored."""

    async def run() -> list[Probed]:
        wire, ticks = Wire(), iter(range(1000))
        prober = Prober(cast("Any", wire), lambda: float(next(ticks)), every_s=0.02, timeout_s=0.01)
        await _run_probes(wire, prober, 3)
        late = ProbeAnswer(client_sent_s=0.0, server_received_ns=7, server_sent_ns=8)
        await prober.take(late, 100.0)
        return wire.readings()

    readings = asyncio.run(run())
    assert [one.client_sent_s for one in readings] == [0.0, 1.0]
    assert {
        (one.server_received_ns, one.server_sent_ns, one.client_received_s) for one in readings
    } == {(None, None, None)}
