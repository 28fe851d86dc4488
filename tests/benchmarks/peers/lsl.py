"""Measure the Lab Streaming Layer with a recorder that works as LabRecorder does."""

import importlib.util
import sys
import time
import uuid
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import psutil
from numpy.typing import NDArray

from app.wire.batch import BODY_JOINTS
from tests.benchmarks.load.figures import MIB
from tests.benchmarks.load.movement import RATE_HZ
from tests.benchmarks.load.processes import Companion
from tests.benchmarks.peers.ours import DOWN_S, FRAMES_PER_MINUTE, Ours
from tests.benchmarks.report import Figure

SESSIONS = 50
PULLS_EVERY_S = 0.5
"""LabRecorder's interval."""
PULLS_OFTEN_S = 0.05
"""The interval at which our server commits."""
PEER = "LSL"
CONFIG = """[ports]
PortRange = 512
IPv6 = disable
[multicast]
ResolveScope = machine
[lab]
SessionID = {session}
"""


@dataclass(frozen=True)
class Recordings:
    """The recordings of a killed recorder and its successor; CPU and wall time (s) of the first."""

    before: Path
    after: Path
    cpu_s: float
    wall_s: float


def lsl_figures(part: str, folder: Path, ours: Ours, duration_s: float) -> Iterator[Figure]:
    """Yield LSL's figures, recording again after a kill of the recorder; none without pylsl."""
    if importlib.util.find_spec("pylsl") is None:
        print(f"  {part}: {PEER} is left out: pylsl is not installed", file=sys.stderr)
        return
    from tests.benchmarks.peers.lsl_recorder import read

    folder.mkdir(parents=True)
    found = _record(folder, 2 * SESSIONS, duration_s)
    before, after = read(found.before), read(found.after)
    rate = len(before.times_s) * BODY_JOINTS / found.wall_s
    peer = f"{PEER}, {SESSIONS} x 2 streams, minimal recorder"
    yield Figure(part, "joint samples", ours.samples_per_s, "1/s", peer, rate)
    yield Figure(
        part,
        "joint samples per core",
        ours.samples_per_core_s,
        "1/s",
        f"{PEER} recorder",
        rate / (found.cpu_s / found.wall_s),
    )
    mib = before.size_bytes / len(before.times_s) * FRAMES_PER_MINUTE / MIB
    yield Figure(part, "stored per session-minute", ours.mib_per_minute, "MiB", peer, mib)
    name = "delivery p99 (ours: durable and acknowledged)"
    for recorded, every_s in ((before, PULLS_EVERY_S), (after, PULLS_OFTEN_S)):
        # The first pull returns the samples that queued while the other streams were opened.
        steady = recorded.written_s > recorded.written_s[0] + 2 * PULLS_EVERY_S
        ages_ms = 1000 * (recorded.written_s - recorded.times_s)[steady]
        beside = f"{PEER} written, not synced, pulled every {every_s:g} s"
        p99 = float(np.percentile(ages_ms, 99))
        yield Figure(part, name, ours.ack_p99_ms, "ms", beside, p99)
    gaps_s = _gaps_s(before.streams, before.times_s, after.streams, after.times_s)
    words = f"{PEER} at kill -9 of the recorder, {DOWN_S:g} s down: lost of each stream"
    yield Figure(part, f"{words}, median", float(np.median(gaps_s)), "s")
    yield Figure(part, f"{words}, max", float(gaps_s.max()), "s")
    lost = float(gaps_s.sum()) * RATE_HZ * BODY_JOINTS
    yield Figure(part, f"{PEER} at kill -9: lost of all", lost, "joint samples")


def _record(folder: Path, streams: int, duration_s: float) -> Recordings:
    """Stream continuously while a recorder is killed and another starts a second later."""
    from tests.benchmarks.peers.lsl_outlets import OutletsPlan
    from tests.benchmarks.peers.lsl_recorder import RecorderPlan

    config = CONFIG.format(session=uuid.uuid4().hex)
    files = folder / "before.data", folder / "after.data"
    plan = OutletsPlan(streams, config)
    with Companion.start("peers.lsl_outlets", plan, folder / "outlets") as outlets:
        outlets.wait_for("ready")
        ended: list[tuple[float, float]] = []
        for file, every_s, lasts_s in zip(
            files, (PULLS_EVERY_S, PULLS_OFTEN_S), (duration_s, duration_s / 2), strict=True
        ):
            plan_here = RecorderPlan(streams, config, every_s, str(file))
            with Companion.start("peers.lsl_recorder", plan_here, folder / "recorder") as recorder:
                recorder.wait_for("ready")
                cpu_s, began_s = _cpu_s(recorder.pid), time.monotonic()
                time.sleep(lasts_s)
                ended.append((_cpu_s(recorder.pid) - cpu_s, time.monotonic() - began_s))
            time.sleep(DOWN_S)
    return Recordings(*files, *ended[0])


def _cpu_s(pid: int) -> float:
    times = psutil.Process(pid).cpu_times()
    return float(times.user + times.system)


def _gaps_s(
    before: NDArray[np.int64],
    before_s: NDArray[np.float64],
    after: NDArray[np.int64],
    after_s: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return each stream's gap between its last sample in one file and the first in the next."""
    return np.array(
        [
            after_s[after == number].min() - before_s[before == number].max() - 1.0 / RATE_HZ
            for number in np.unique(before)
        ]
    )
