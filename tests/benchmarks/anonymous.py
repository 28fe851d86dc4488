"""Measure how a hundred anonymous callers affect eight headsets that stream.

Half of the callers try to sign in, half send bodies of 2 MB, all as fast as they get responses. The
peer is the same server with the same headsets while the same callers call a bare listener that
answers 413: the difference is the cost of our own request handling. Runs of both kinds alternate.
"""

import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import psutil

from tests.benchmarks.acknowledgement import SESSIONS, paired_headset, stream
from tests.benchmarks.load.processes import Companion
from tests.benchmarks.report import Figure, Report
from tests.benchmarks.strangers import CallersPlan, ListenerPlan
from tests.support.server import LiveServer, free_port

PARTS = ("flood",)
DURATION_S, RUNS, CALLERS = 60.0, 3, 100
SETTLED_S = 3.0
"""How long the headsets stream before the callers start."""
MOST_RATIO, MOST_GROWTH_MIB = 1.5, 100.0


@dataclass(frozen=True)
class Run:
    """The figures of one run with callers.

    `ack_p99_s` covers messages sent while the callers were active. The other figures are the growth
    of the server's memory, its processor time per second, and the number of responses to the
    callers.
    """

    ack_p50_s: float
    ack_p99_s: float
    growth_mib: float
    cpu_share: float
    answers: Counter[str]


def measure(parts: frozenset[str], duration_s: float = DURATION_S, runs: int = RUNS) -> Report:
    """Alternate `runs` of both kinds, with callers at the server and at a bare listener."""
    report = Report("anonymous")
    ours: list[Run] = []
    peers: list[Run] = []
    if not parts:
        return report
    with tempfile.TemporaryDirectory(prefix="reembody-bench-") as scratch:
        for number in range(runs):
            kinds = (True, False) if number % 2 == 0 else (False, True)
            for at_server in kinds:
                folder = Path(scratch) / f"{number}-{at_server}"
                (ours if at_server else peers).append(_run(folder, duration_s, at_server=at_server))
    ratios = [own.ack_p99_s / peer.ack_p99_s for own, peer in zip(ours, peers, strict=True)]
    ack_s, peer_s = (float(np.median([one.ack_p99_s for one in some])) for some in (ours, peers))
    growth, ratio = max(one.growth_mib for one in ours), float(np.median(ratios))
    answers = sum((one.answers for one in ours), Counter[str]())
    report.beside |= {
        "callers": CALLERS,
        "seconds": duration_s,
        "runs": runs,
        "ack_p99_s": ack_s,
        "peer_ack_p99_s": peer_s,
        "ratio": ratio,
        "ratios": ratios,
        "memory_growth_mib": growth,
        "peer_memory_growth_mib": max(one.growth_mib for one in peers),
        "answers": dict(answers),
    }
    words = f"{CALLERS} callers beside {SESSIONS} headsets"
    bare = "the callers at a bare listener"
    peer_p50 = float(np.median([one.ack_p50_s for one in peers]))
    report.add(
        Figure("flood", f"durable ack p99, {words}", 1000 * ack_s, "ms", bare, 1000 * peer_s),
        Figure(
            "flood",
            "durable ack p50",
            1000 * float(np.median([one.ack_p50_s for one in ours])),
            "ms",
            bare,
            1000 * peer_p50,
        ),
        Figure("flood", "p99 over the peer's, median of runs", ratio, "", "at most", MOST_RATIO),
        Figure("flood", "server memory, growth", growth, "MiB", "at most", MOST_GROWTH_MIB),
        Figure(
            "flood",
            "server CPU",
            100 * float(np.median([one.cpu_share for one in ours])),
            "% of a core",
            bare,
            100 * float(np.median([one.cpu_share for one in peers])),
        ),
        Figure(
            "flood",
            "answers per second",
            answers.total() / (runs * duration_s),
            "1/s",
            bare,
            sum((one.answers for one in peers), Counter[str]()).total() / (runs * duration_s),
        ),
    )
    return report


def _run(folder: Path, duration_s: float, *, at_server: bool) -> Run:
    folder.mkdir()
    told: list[tuple[float, float]] = []
    with LiveServer(folder) as server, _door(server, folder, at_server=at_server) as port:
        tokens = [paired_headset(server) for _ in range(SESSIONS)]
        streamed_s = duration_s + 2 * SETTLED_S
        headsets = threading.Thread(target=lambda: told.extend(stream(server, tokens, streamed_s)))
        # The headsets import for a while; the callers start when batches flow.
        headsets.start()
        time.sleep(2 * SETTLED_S)
        process = psutil.Process(server.pid)
        before, cpu_before, began_s = _memory_and_time(process)
        plan = CallersPlan(port, CALLERS, duration_s)
        with (
            Companion.start("strangers", plan, folder / "callers.log") as callers,
            _peak_memory(process) as peak,
        ):
            callers.wait_for("ready")
            answers = Counter(callers.result())
        _, cpu_after, ended_s = _memory_and_time(process)
        headsets.join()
    took_s = [took for sent_s, took in told if SETTLED_S <= sent_s < SETTLED_S + duration_s]
    if not took_s:
        raise RuntimeError("nothing was acknowledged while the callers called")
    p50, p99 = np.percentile(took_s, [50, 99])
    return Run(
        float(p50),
        float(p99),
        (max(peak) - before) / 2**20,
        (cpu_after - cpu_before) / (ended_s - began_s),
        answers,
    )


def _memory_and_time(process: psutil.Process) -> tuple[int, float, float]:
    """Return a process's memory (bytes) and processor time (s), and the current time (s)."""
    times = process.cpu_times()
    return process.memory_info().rss, times.user + times.system, time.monotonic()


@contextmanager
def _door(server: LiveServer, folder: Path, *, at_server: bool) -> Iterator[int]:
    """Yield the port to which the callers connect."""
    if at_server:
        yield server.port
        return
    port = free_port()
    with Companion.start("strangers", ListenerPlan(port), folder / "listener.log") as listener:
        listener.wait_for("ready")
        yield port


@contextmanager
def _peak_memory(process: psutil.Process) -> Iterator[list[int]]:
    """Record the server's memory (bytes) every tenth of a second while the block runs."""
    found, ended = [process.memory_info().rss], threading.Event()

    def watch() -> None:
        while not ended.wait(0.1):
            found.append(process.memory_info().rss)

    watcher = threading.Thread(target=watch)
    watcher.start()
    try:
        yield found
    finally:
        ended.set()
        watcher.join()
