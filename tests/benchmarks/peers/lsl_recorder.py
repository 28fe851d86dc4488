"""A minimal LSL recorder: `python -m tests.benchmarks.peers.lsl_recorder`.

It finds the streams and writes pulled samples to a file as LabRecorder does: every stream is pulled
at an interval (there 0.5 s), written through a buffered file, never synced; there is no journal. A
record is a head (stream, samples, written at) and, as in XDF, samples with an 8-byte timestamp and
a byte for its length. Prints `ready` when all streams are open, records until it is killed.
"""

import importlib
import json
import struct
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from app.wire import VALUES_PER_FRAME
from tests.benchmarks.peers.lsl_outlets import KIND

# It has no type annotations.
pylsl: Any = importlib.import_module("pylsl")
RESOLVES_WITHIN_S, OPENS_WITHIN_S = 30.0, 30.0
HEAD = struct.Struct("<IId")
SAMPLE = np.dtype([("length", "u1"), ("t_s", "<f8"), ("values", "<f4", (VALUES_PER_FRAME,))])
TIME_STAMP_BYTES = 8


@dataclass(frozen=True)
class RecorderPlan:
    """The streams, the pull interval, and the file."""

    streams: int
    config: str
    every_s: float
    file: str

    def as_json(self) -> str:
        """Return the plan as one line of JSON."""
        return json.dumps(asdict(self))


@dataclass(frozen=True)
class Recorded:
    """The contents of a file and its size.

    One row per sample: stream, timestamp (s), time of writing (s).
    """

    streams: NDArray[np.int64]
    times_s: NDArray[np.float64]
    written_s: NDArray[np.float64]
    size_bytes: int


def run(plan: RecorderPlan) -> None:
    """Record until the process is killed."""
    pylsl.util.set_config_content(plan.config)
    inlets = _open(plan.streams)
    print("ready", flush=True)
    next_s = time.monotonic()
    with Path(plan.file).open("wb") as file:
        while True:
            for number, inlet in inlets.items():
                _pull(file, number, inlet)
            next_s += plan.every_s
            time.sleep(max(0.0, next_s - time.monotonic()))


def read(path: Path) -> Recorded:
    """Read the complete records of a file, whose last record may be torn."""
    data = path.read_bytes()
    streams, times_s, written_s = [], [], []
    at = 0
    while at + HEAD.size <= len(data):
        number, count, when_s = HEAD.unpack_from(data, at)
        at += HEAD.size
        if at + count * SAMPLE.itemsize > len(data):
            break
        times_s.append(np.frombuffer(data, SAMPLE, count, at)["t_s"])
        streams.append(np.full(count, number))
        written_s.append(np.full(count, when_s))
        at += count * SAMPLE.itemsize
    return Recorded(
        np.concatenate(streams), np.concatenate(times_s), np.concatenate(written_s), len(data)
    )


def _open(streams: int) -> dict[int, Any]:
    """Open all streams in parallel, as LabRecorder does with a thread for each."""
    found = pylsl.resolve_byprop("type", KIND, minimum=streams, timeout=RESOLVES_WITHIN_S)
    numbers = {int(info.source_id().rpartition("-")[2]): info for info in found}
    if len(numbers) < streams:
        raise RuntimeError(f"found {len(numbers)} of {streams} streams")
    inlets = {number: pylsl.StreamInlet(info) for number, info in sorted(numbers.items())}
    with ThreadPoolExecutor(streams) as pool:
        list(pool.map(lambda inlet: inlet.open_stream(OPENS_WITHIN_S), inlets.values()))
    return inlets


def _pull(file: BinaryIO, number: int, inlet: Any) -> None:
    values, times_s = inlet.pull_chunk(timeout=0.0, max_samples=1024, as_numpy=True)
    if not len(times_s):
        return
    samples = np.empty(len(times_s), SAMPLE)
    samples["length"], samples["t_s"], samples["values"] = TIME_STAMP_BYTES, times_s, values
    file.write(HEAD.pack(number, len(samples), pylsl.local_clock()))
    file.write(samples.tobytes())


def main() -> None:
    """Read the plan from standard input and run it."""
    run(RecorderPlan(**json.loads(sys.stdin.readline())))


if __name__ == "__main__":
    main()
