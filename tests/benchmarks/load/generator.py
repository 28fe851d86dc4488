"""Run headsets in a separate process: `python -m tests.benchmarks.load.generator`.

Standard input: a line with the plan (JSON). The process prints `connected`, then, when every
session's phase runs, `ready`; then it reads a line with the start time (s, monotonic clock of the
machine). It writes its messages to the plan's file and the counters to standard output.
"""

import asyncio
import json
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import uvloop

from tests.benchmarks.load.headset import Headset, RealHeadset
from tests.benchmarks.load.lean import LeanHeadset
from tests.benchmarks.load.movement import LOOP_FRAMES, RATE_HZ, Movement, make_movement
from tests.benchmarks.load.record import Record
from tests.benchmarks.load.streaming import FRAMES_PER_BATCH, Streaming

MOVEMENTS = 4
CONNECT_AT_ONCE = 8
DRAINS_WITHIN_S = 60.0


@dataclass(frozen=True)
class Seat:
    """A session of the load: its `number` in the run, and the token of its headset."""

    number: int
    session_id: str
    token: str


@dataclass(frozen=True)
class GeneratorPlan:
    """The work of one generator process; `client` is `lean`, or `real` for the product's client.

    Every frame is digested in sessions whose number is a multiple of `digest_every`.
    """

    url: str
    client: str
    seats: tuple[Seat, ...]
    duration_s: float
    contact_every_s: float | None
    digest_every: int
    messages: str

    def as_json(self) -> str:
        """Return the plan as one line of JSON."""
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text: str) -> "GeneratorPlan":
        """Return the plan of a line made by `as_json`."""
        read: dict[str, Any] = json.loads(text)
        return cls(**{**read, "seats": tuple(Seat(**seat) for seat in read["seats"])})


async def run(plan: GeneratorPlan) -> dict[str, Any]:
    """Connect all headsets, wait for the start time, stream, and wait for the last acks."""
    movements = [make_movement(np.random.default_rng(seed)) for seed in range(MOVEMENTS)]
    gate = asyncio.Semaphore(CONNECT_AT_ONCE)
    streams = await asyncio.gather(*(_seated(plan, seat, movements, gate) for seat in plan.seats))
    print("connected", flush=True)
    await asyncio.gather(*(stream.enter_phase() for stream in streams))
    print("ready", flush=True)
    begin_s = float(await asyncio.to_thread(sys.stdin.readline))
    cpu_s = time.process_time()
    await asyncio.gather(
        *(
            stream.run(begin_s + _out_of_step_s(seat), begin_s + plan.duration_s)
            for stream, seat in zip(streams, plan.seats, strict=True)
        )
    )
    cpu_s = time.process_time() - cpu_s
    await _settled(streams)
    for stream in streams:
        await stream.headset.close()
    rows = [s.record.columns(seat.number) for s, seat in zip(streams, plan.seats, strict=True)]
    np.save(Path(plan.messages), np.concatenate(rows))
    lags_s = np.concatenate([np.asarray(stream.lag_s) for stream in streams])
    return {
        "cpu_s": cpu_s,
        "lag_s": dict(zip(("p50", "p99", "max"), _percentiles(lags_s), strict=True)),
        "sessions": [stream.record.summary() for stream in streams],
    }


async def _seated(
    plan: GeneratorPlan, seat: Seat, movements: list[Movement], gate: asyncio.Semaphore
) -> Streaming:
    record = Record(seat.session_id)
    opens = RealHeadset.open if plan.client == "real" else LeanHeadset.open
    async with gate:
        headset: Headset = await opens(plan.url, seat.token, record)
    return Streaming(
        headset,
        record,
        movements[seat.number % MOVEMENTS],
        offset=seat.number * 977 % LOOP_FRAMES,
        contact_every_s=plan.contact_every_s,
        digested=seat.number % plan.digest_every == 0,
    )


def _out_of_step_s(seat: Seat) -> float:
    """Spread the headsets evenly over the time between two messages, as real ones are."""
    return seat.number * 0.618034 % 1.0 * FRAMES_PER_BATCH / RATE_HZ


async def _settled(streams: list[Streaming]) -> None:
    """Wait for the last acknowledgements; a message without one gets no latency."""
    give_up_s = time.monotonic() + DRAINS_WITHIN_S
    while time.monotonic() < give_up_s:
        if all(stream.record.is_settled or stream.record.failure for stream in streams):
            return
        await asyncio.sleep(0.05)


def _percentiles(values: "np.typing.NDArray[np.float64]") -> list[float]:
    return [float(value) for value in np.percentile(values, [50, 99, 100])]


def main() -> None:
    """Read the plan from standard input and run it."""
    plan = GeneratorPlan.from_json(sys.stdin.readline())
    with asyncio.Runner(loop_factory=uvloop.new_event_loop) as runner:
        print(json.dumps(runner.run(run(plan))), flush=True)


if __name__ == "__main__":
    main()
