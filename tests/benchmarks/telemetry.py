"""Measure fifty headsets in parallel: time until data are durable and shown, and server load.

Parts: `load` on SQLite, `load-postgresql` on a durable PostgreSQL, `knee` (how many sessions are
too many), `backlog` (one reconnects with ten minutes in its journal), `memory` (whether the
server's grows within an hour, `--minutes 60`), `peers` (other systems with the same frames).
"""

import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path

from tests.benchmarks.load.backlog import backlog_figures
from tests.benchmarks.load.durable_postgres import durable_postgres
from tests.benchmarks.load.figures import load_figures
from tests.benchmarks.load.knee import STEP_S, knee_figures
from tests.benchmarks.load.memory import memory_figures
from tests.benchmarks.load.plans import Load
from tests.benchmarks.load.scenario import run_load
from tests.benchmarks.peers.figures import peer_figures
from tests.benchmarks.report import Figure, Report

DURATION_S = 600.0
Part = Callable[[Path, float], Iterable[Figure]]


def measure(parts: frozenset[str], duration_s: float = DURATION_S) -> Report:
    """Measure the named parts in a scratch folder; short parts take at most `duration_s`."""
    report = Report("telemetry")
    with tempfile.TemporaryDirectory(prefix="reembody-bench-") as scratch:
        for name, part in _PARTS.items():
            if name in parts:
                for figure in part(Path(scratch) / name, duration_s):
                    report.add(figure)
    return report


def _load(folder: Path, duration_s: float) -> Iterable[Figure]:
    return load_figures("load", run_load(folder, Load(duration_s=duration_s)))


def _load_postgresql(folder: Path, duration_s: float) -> Iterable[Figure]:
    with durable_postgres() as store:
        return load_figures("load-postgresql", run_load(folder, Load(duration_s=duration_s), store))


def _knee(folder: Path, duration_s: float) -> Iterable[Figure]:
    return knee_figures("knee", folder, min(STEP_S, duration_s))


def _backlog(folder: Path, duration_s: float) -> Iterable[Figure]:
    return backlog_figures("backlog", folder, duration_s)


def _memory(folder: Path, duration_s: float) -> Iterable[Figure]:
    return memory_figures("memory", folder, duration_s)


def _peers(folder: Path, duration_s: float) -> Iterable[Figure]:
    return peer_figures("peers", folder, duration_s)


_PARTS: dict[str, Part] = {
    "load": _load,
    "load-postgresql": _load_postgresql,
    "knee": _knee,
    "backlog": _backlog,
    "memory": _memory,
    "peers": _peers,
}
PARTS = tuple(_PARTS)
