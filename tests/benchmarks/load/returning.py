"""Simulate a headset that was cut off: `python -m tests.benchmarks.load.returning`.

It connects once, begins its phase and disconnects; then it fills its journal on the disk with the
data it would have produced meanwhile. At the start time it waits, opens the journal again as a
restarted program does, and sends all of it through the product's own client, while it produces new
frames in real time. It uses the generator's protocol with the parent.
"""

import asyncio
import contextlib
import json
import sys
import time
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import uvloop

from app.client.file_journal import FileJournal
from app.client.telemetry import TelemetryClient
from app.wire import StreamName
from app.wire.messages import REPORT_STREAM
from tests.benchmarks.load.headset import RealHeadset
from tests.benchmarks.load.movement import RATE_HZ, make_movement
from tests.benchmarks.load.record import Record
from tests.benchmarks.load.streaming import FRAMES_PER_BATCH, Streaming


@dataclass
class LeftJournal(FileJournal):
    """The client's own journal; `left` is the number of messages in it when it was opened."""

    left: int = 0
    is_drained: asyncio.Event = field(default_factory=asyncio.Event)

    def __post_init__(self) -> None:
        super().__post_init__()
        self.left = self.end

    def acknowledge(self, positions: Iterable[tuple[str, int, int]]) -> None:
        """Remove stored messages, and record when none of the earlier ones is left."""
        super().acknowledge(positions)
        if self.first >= self.left:
            self.is_drained.set()


@dataclass(frozen=True)
class ReturnPlan:
    """The plan of a headset that journals `frames` of each stream and reconnects later.

    It gives up `gives_up_s` after it reconnected.
    """

    url: str
    session_id: str
    token: str
    journal: str
    frames: int
    comes_back_s: float
    gives_up_s: float

    def as_json(self) -> str:
        """Return the plan as one line of JSON."""
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text: str) -> "ReturnPlan":
        """Return the plan of a line made by `as_json`."""
        return cls(**json.loads(text))


async def run(plan: ReturnPlan) -> dict[str, Any]:
    """Begin a phase, disconnect and reconnect; return when this happened and the journal was empty.

    Times are in monotonic seconds.
    """
    before = await _before(plan)
    print("ready", flush=True)
    begin_s = float(await asyncio.to_thread(sys.stdin.readline))
    await asyncio.sleep(begin_s + plan.comes_back_s - time.monotonic())
    back_s, cpu_s = time.monotonic(), time.process_time()
    client, journal = _client(plan)
    left, size_bytes = journal.left, journal.waiting_bytes
    async with client:
        live = _streaming(plan, client)
        live.phase_id, live.active_from_s = before.phase_id, plan.frames / RATE_HZ
        making = asyncio.create_task(live.run(time.monotonic(), float("inf")))
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(journal.is_drained.wait(), plan.gives_up_s)
        drained_s = time.monotonic()
        making.cancel()
        await asyncio.gather(making, return_exceptions=True)
    is_drained = journal.is_drained.is_set()
    counts = dict.fromkeys(map(str, StreamName), plan.frames)
    counts[REPORT_STREAM] = 1 + len(_touches(plan))
    session = {
        "session_id": plan.session_id,
        "epoch": before.headset.epoch,
        "failure": None if is_drained else f"{left - journal.first} messages were left",
        "handed": counts,
        "acked": counts if is_drained else dict.fromkeys(counts, 0),
        "digests": {},
    }
    return {
        "back_s": back_s,
        "drained_s": drained_s,
        "is_drained": is_drained,
        "messages": left,
        "size_bytes": size_bytes,
        "cpu_s": time.process_time() - cpu_s,
        "sessions": [session],
    }


async def _before(plan: ReturnPlan) -> Streaming:
    """Run until the cut: begin the phase, and journal what is produced afterwards."""
    client, journal = _client(plan)
    async with client:
        print("connected", flush=True)
        made = _streaming(plan, client)
        await made.enter_phase()
        await client.drained()
    for seq in range(0, plan.frames, FRAMES_PER_BATCH):
        await made.send(seq)
        if seq in _touches(plan):
            await made.touch(seq / RATE_HZ)
    journal.close()
    return made


def _touches(plan: ReturnPlan) -> range:
    """Return the sequence numbers of the contacts to report, one per second."""
    return range(int(RATE_HZ), plan.frames, int(RATE_HZ))


def _client(plan: ReturnPlan) -> tuple[TelemetryClient, LeftJournal]:
    journal = LeftJournal(folder=Path(plan.journal))
    client = TelemetryClient(plan.url, plan.token, "returning", time.monotonic, journal=journal)
    return client, journal


def _streaming(plan: ReturnPlan, client: TelemetryClient) -> Streaming:
    return Streaming(
        RealHeadset(client),
        Record(plan.session_id),
        make_movement(np.random.default_rng(11)),
        offset=0,
        contact_every_s=None,
        digested=False,
    )


def main() -> None:
    """Read the plan from standard input and run it."""
    plan = ReturnPlan.from_json(sys.stdin.readline())
    with asyncio.Runner(loop_factory=uvloop.new_event_loop) as runner:
        print(json.dumps(runner.run(run(plan))), flush=True)


if __name__ == "__main__":
    main()
