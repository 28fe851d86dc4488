"""Simulate a lab's headsets on LSL: `python -m tests.benchmarks.peers.lsl_outlets`.

The Lab Streaming Layer (LSL) gets one outlet per stream, 91 float32 channels at 90 Hz, pushed six
samples at a time as ours are sent. Prints `ready` when all outlets are open, then streams until it
is killed.
"""

import importlib
import json
import sys
import time
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from app.wire import VALUES_PER_FRAME
from tests.benchmarks.load.movement import LOOP_FRAMES, RATE_HZ, make_movement
from tests.benchmarks.load.streaming import FRAMES_PER_BATCH

# It has no type annotations.
pylsl: Any = importlib.import_module("pylsl")
KIND = "reembody-benchmark"


@dataclass(frozen=True)
class OutletsPlan:
    """The number of streams, and the library's `config` that isolates them from other streams."""

    streams: int
    config: str

    def as_json(self) -> str:
        """Return the plan as one line of JSON."""
        return json.dumps(asdict(self))


def run(plan: OutletsPlan) -> None:
    """Stream from all outlets in real time."""
    pylsl.util.set_config_content(plan.config)
    outlets = [_outlet(number) for number in range(plan.streams)]
    movement = make_movement(np.random.default_rng(5))
    print("ready", flush=True)
    began_s = time.monotonic()
    pushed = 0
    while True:
        # Streams are spread evenly over the time between two messages.
        due_s = began_s + pushed / plan.streams * FRAMES_PER_BATCH / RATE_HZ
        time.sleep(max(0.0, due_s - time.monotonic()))
        number, turn = pushed % plan.streams, pushed // plan.streams
        at = (number * 977 + turn * FRAMES_PER_BATCH) % LOOP_FRAMES
        outlets[number].push_chunk(movement.target[at : at + FRAMES_PER_BATCH])
        pushed += 1


def _outlet(number: int) -> Any:
    info = pylsl.StreamInfo(
        f"stream {number}",
        KIND,
        VALUES_PER_FRAME,
        RATE_HZ,
        pylsl.cf_float32,
        f"{KIND}-{number}",
    )
    return pylsl.StreamOutlet(info)


def main() -> None:
    """Read the plan from standard input and run it."""
    run(OutletsPlan(**json.loads(sys.stdin.readline())))


if __name__ == "__main__":
    main()
