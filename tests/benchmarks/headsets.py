"""Headsets that only stream, in a process of their own: `python -m tests.benchmarks.headsets`.

Reads the plan as JSON from standard input, streams in real time, and prints for every message when
it was passed to the client (s since its headset began) and the time until its acknowledgement (s).
"""

import asyncio
import json
import sys
import time
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from app.client.journal import Entry, Journal
from app.client.telemetry import TelemetryClient
from app.rehearsal.rehearse import AVATARS
from app.wire import BODY_STREAMS, VALUES_PER_FRAME, StreamName, encode_batch

RATE_HZ = 90.0
FRAMES_PER_BATCH = 6


@dataclass
class TimedJournal(Journal):
    """A journal that measures the time from each message to its acknowledgement."""

    added_s: dict[int, float] = field(default_factory=dict)
    latencies_s: list[tuple[float, float]] = field(default_factory=list)

    def add(self, entry: Entry) -> None:
        """Add a message and record the time."""
        self.added_s[self.end] = time.monotonic()
        super().add(entry)

    def acknowledge(self, positions: Iterable[tuple[str, int, int]]) -> None:
        """Record how long the acknowledged messages waited."""
        before, now_s = self.first, time.monotonic()
        super().acknowledge(positions)
        for at in range(before, self.first):
            added_s = self.added_s.pop(at)
            self.latencies_s.append((added_s, now_s - added_s))


async def stream(url: str, token: str, duration_s: float, seed: int) -> list[tuple[float, float]]:
    """Stream from one headset; return each message's send time and latency."""
    journal, began_s = TimedJournal(), time.monotonic()
    values = movement(seed)
    async with TelemetryClient(
        url,
        token,
        f"benchmark {seed}",
        lambda: time.monotonic() - began_s,
        avatars=AVATARS,
        journal=journal,
    ) as client:
        # Headsets are not synchronised.
        await asyncio.sleep(float(np.random.default_rng(seed).uniform(0, 0.07)))
        start_s = time.monotonic()
        for batch in range(int(duration_s * RATE_HZ / FRAMES_PER_BATCH)):
            seq = batch * FRAMES_PER_BATCH
            for name in BODY_STREAMS:
                message = batch_of(name, client.epoch, seq, values)
                await client.send_batch(name, seq + FRAMES_PER_BATCH, message)
            due_s = start_s + (seq + FRAMES_PER_BATCH) / RATE_HZ
            await asyncio.sleep(max(0.0, due_s - time.monotonic()))
        await client.drained()
    return [(added_s - start_s, latency_s) for added_s, latency_s in journal.latencies_s]


def batch_of(
    name: StreamName, epoch: int, seq: int, values: "np.typing.NDArray[np.float32]"
) -> bytes:
    """Return a batch of `values` (900 and more, 91) beginning at `seq`."""
    times_s = (seq + np.arange(FRAMES_PER_BATCH)) / RATE_HZ
    return encode_batch(
        name,
        epoch=epoch,
        phase_id=0,
        seq_first=seq,
        times_s=times_s,
        flags=np.zeros(FRAMES_PER_BATCH, np.uint8),
        values=values[seq % 900 : seq % 900 + FRAMES_PER_BATCH],
        active_s=0.0,
        closed_at_s=float(times_s[-1]),
    )


def movement(seed: int) -> "np.typing.NDArray[np.float32]":
    """Return ten seconds of slow rotations (900 + a batch, 91), unit quaternions."""
    rng = np.random.default_rng(seed)
    count = 900 + FRAMES_PER_BATCH
    angle = np.cumsum(rng.normal(scale=0.01, size=(count, 22)), axis=0)
    values = np.zeros((count, VALUES_PER_FRAME))
    values[:, :3] = np.cumsum(rng.normal(scale=0.001, size=(count, 3)), axis=0)
    values[:, 3::4], values[:, 4::4] = np.cos(angle / 2), np.sin(angle / 2)
    return values.astype(np.float32)


async def main(plan: dict[str, Any]) -> list[tuple[float, float]]:
    """Run all headsets in parallel."""
    found = await asyncio.gather(
        *(
            stream(plan["url"], token, plan["duration_s"], seed)
            for seed, token in enumerate(plan["tokens"])
        )
    )
    return [message for one in found for message in one]


if __name__ == "__main__":
    json.dump(asyncio.run(main(json.load(sys.stdin))), sys.stdout)
