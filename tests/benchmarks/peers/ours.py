"""Measure the product itself, and the effect of killing its server."""

import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.wire.batch import BODY_JOINTS
from tests.benchmarks.load.figures import MIB, ack_ms, samples_per_s
from tests.benchmarks.load.lab import make_lab
from tests.benchmarks.load.movement import RATE_HZ
from tests.benchmarks.load.plans import Load, companions
from tests.benchmarks.load.scenario import (
    BEGINS_IN_S,
    Outcome,
    Store,
    database_url,
    live_server,
)
from tests.benchmarks.load.verify import verify
from tests.benchmarks.report import Figure

FRAMES_PER_MINUTE = 2 * 90 * 60
SAMPLES_PER_MINUTE = FRAMES_PER_MINUTE * BODY_JOINTS
"""Rotations of one joint in one stream, of one session."""
SAMPLES_PER_SESSION_S = SAMPLES_PER_MINUTE / 60
DOWN_S = 1.0
KILLED_SESSIONS = 20


@dataclass(frozen=True)
class Ours:
    """The product's figures to compare with; `mib_per_minute` is of one session, folded."""

    ack_p50_ms: float
    ack_p99_ms: float
    samples_per_s: float
    samples_per_core_s: float
    mib_per_minute: float


def ours_of(outcome: Outcome) -> Ours:
    """Return the figures of a load that are also measured for the peers."""
    p50, p99 = np.percentile(ack_ms(outcome), [50, 99])
    rate, found = samples_per_s(outcome), outcome.verdict
    return Ours(
        ack_p50_ms=float(p50),
        ack_p99_ms=float(p99),
        samples_per_s=rate,
        samples_per_core_s=rate / outcome.watch.cpu_share(),
        mib_per_minute=found.chunk_bytes / max(1, found.chunk_frames) * FRAMES_PER_MINUTE / MIB,
    )


def killed_figures(part: str, folder: Path, duration_s: float) -> Iterator[Figure]:
    """Kill the server with SIGKILL in mid-load, restart it a second later, and count losses."""
    load = Load(
        sessions=KILLED_SESSIONS,
        duration_s=duration_s,
        real=KILLED_SESSIONS,
        consoles=0,
        digest_every=1,
    )
    server = live_server(folder, Store())
    with server:
        lab = make_lab(server, load.sessions)
        with companions(folder, server, lab, load) as these:
            begin_s = time.monotonic() + BEGINS_IN_S
            for one in these.everybody():
                one.begin(begin_s)
            time.sleep(BEGINS_IN_S + duration_s / 2)
            killed_s = time.monotonic()
            server.kill()
            print(f"  {part}: killed the server", file=sys.stderr)
            time.sleep(DOWN_S)
            server.start()
            sessions = these.generators["real"].result()["sessions"]
    verdict = verify(database_url(server, Store()), sessions)
    messages = np.load(folder / "real.npy")
    acked_s = messages[:, 2] + np.nan_to_num(messages[:, 3], nan=np.inf)
    waited = (messages[:, 2] <= killed_s) & (acked_s > killed_s)
    missing = verdict.handed - verdict.stored
    frames = 2 * load.sessions * RATE_HZ
    words = f"ours at kill -9, {load.sessions} sessions, {DOWN_S:g} s down"
    yield Figure(part, f"{words}: acknowledged and lost", verdict.lost, "frames and reports")
    yield Figure(part, f"{words}: messages only in the journals", int(waited.sum()), "messages")
    yield Figure(part, f"{words}: not stored in the end", missing, "of", "", verdict.handed)
    yield Figure(part, f"{words}: streams' time lost", missing / frames, "s of all")
    yield Figure(part, f"{words}: stored twice", verdict.duplicated, "frames and reports")
    yield Figure(
        part, f"{words}: streams not bit-exact", verdict.differing, "", "of", verdict.digested
    )
