"""Make each disk call of start, restore, backup, export, upload and erasure fail once.

Each operation is traced once to find its calls; then each call is made to fail on a fresh copy of a
real data folder (`tests/faults/io_faults.py`), the result is checked, and a server is started.
Needs Linux on x86-64 and a system that lets a process trace its own child.
"""

import errno
import json
import os
import pickle
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from tests.benchmarks.report import CannotMeasure, Figure, Report
from tests.faults.io_faults import OPERATIONS, source_in
from tests.faults.tracing.injecting import injecting_machine
from tests.faults.tracing.running import why_not
from tests.support.nursery import STUDIES, nursery
from tests.support.shipped_studies import write_delayed_copies

REPOSITORY = Path(__file__).resolve().parents[2]
PARTS = tuple(OPERATIONS)
PROGRAM = "import sys; from tests.faults.io_faults import main; main(*sys.argv[1:])"
TOLD = 40


def measure(parts: frozenset[str], runs: int = 0) -> Report:
    """Inject faults at every call, or about `runs` per operation, spread evenly."""
    with tempfile.TemporaryDirectory() as folder:
        refused = why_not(Path(folder))
    if refused or injecting_machine() is None:
        raise CannotMeasure(refused or "system calls of this machine cannot be made to fail")
    report = Report("io_faults")
    with tempfile.TemporaryDirectory() as folder:
        studies = Path(folder) / "studies"
        write_delayed_copies(studies)
        # The nursery, which starts with the first server, passes it on.
        os.environ[STUDIES] = str(studies)
        source = Path(folder) / "source"
        source.write_bytes(pickle.dumps(source_in(Path(folder) / "live")))
        measured = {part: _measured(part, source, runs) for part in PARTS if part in parts}
    found = [one for told in measured.values() for one in told["found"]]
    for part, told in measured.items():
        report.add(*_figures(part, told))
    bad = [one for one in found if one["lost"] or one["unknown"] or one["moved"] or _trace(one)]
    report.beside = {
        "sites": sum(told["sites"] for told in measured.values()),
        "injected": sum(one["hit"] for one in found),
        "acknowledged_lost": sum(bool(one["lost"]) for one in found),
        "unknown_files": sum(len(one["unknown"]) for one in found),
        "databases_moved": sum(bool(one["moved"]) for one in found),
        "tracebacks": sum(_trace(one) for one in found),
        "errors": sorted({one["error"] for one in found}, key=lambda name: getattr(errno, name)),
        "wrong": bad[:TOLD],
    }
    return report


def _measured(part: str, source: Path, runs: int) -> dict[str, Any]:
    result = source.with_name("result.json")
    workers = nursery().workers.hex()
    subprocess.run(
        [sys.executable, "-c", PROGRAM, str(source), part, workers, str(runs), str(result)],
        cwd=REPOSITORY,
        check=True,
        stdout=sys.stderr,
    )
    told: dict[str, Any] = json.loads(result.read_text(encoding="utf-8"))
    return told


def _figures(part: str, told: dict[str, Any]) -> list[Figure]:
    found = told["found"]
    refused = sum(not one["outcome"]["ok"] for one in found)
    return [
        Figure(part, "sites", told["sites"], ""),
        Figure(part, "faults injected", sum(one["hit"] for one in found), ""),
        Figure(part, "refused in words", refused - sum(map(_trace, found)), ""),
        Figure(part, "runs that lost something", _count(found, "lost"), "", "at most", 0),
        Figure(part, "runs with unknown files", _count(found, "unknown"), "", "at most", 0),
        Figure(part, "runs that moved a database", _count(found, "moved"), "", "at most", 0),
        Figure(part, "tracebacks", sum(map(_trace, found)), "", "at most", 0),
    ]


def _count(found: list[dict[str, Any]], what: str) -> int:
    return sum(bool(one[what]) for one in found)


def _trace(one: dict[str, Any]) -> bool:
    """Return whether the run reported a program error's traceback instead of a message."""
    return bool(one["outcome"]["trace"]) or "Traceback" in one["outcome"]["said"]
