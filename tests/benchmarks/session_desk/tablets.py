"""Measure sixteen tablets that submit fourteen statements at full speed, here and in oTree."""

import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import psutil

from tests.benchmarks.load.durable_postgres import durable_postgres
from tests.benchmarks.peers.otree import VERSION, running_otree
from tests.benchmarks.report import Figure
from tests.benchmarks.session_desk.site import ITEMS, signed_in, statements
from tests.benchmarks.session_desk.submitting import Plan, Submitted
from tests.support.server import LiveServer

PART = "tablets"
TABLETS, FORMS, FORMS_WITH_PAUSES = 16, 20, 5
THINKING_S = 2.0
P95_LIMIT_MS, TIMES_AS_MANY = 50.0, 5.0
RUN_WITHIN_S = 300.0
FLUSHED_BYTES, FLUSHING_S = 32 * 1024, 1.0
"""What a form adds to SQLite's log, and for how long the disk is measured."""


@dataclass(frozen=True)
class Sent:
    """What the tablets sent to one server: without a pause, and with time to think."""

    steadily: Submitted
    with_pauses: Submitted


def figures(folder: Path) -> Iterator[Figure]:
    """Measure every system one after the other, on the same machine with the same clients."""
    ours = {"SQLite": _ours(folder / "sqlite", {})}
    with durable_postgres() as store:
        address = {"REEMBODY_DATABASE_URL": str(store.url)}
        ours["PostgreSQL"] = _ours(folder / "postgresql", address)
    with running_otree(folder / "otree", statements(), TABLETS, FORMS) as otree:
        who = tuple(otree.first_page(at) for at in range(TABLETS))
        theirs = _run(Plan("otree", otree.port, who, FORMS, ITEMS), otree.pid)
    for engine, sent in ours.items():
        yield from compare(engine, sent, theirs)
    what = f"flushes of {FLUSHED_BYTES // 1024} KiB to the disk, each shared by {TABLETS} at most"
    yield Figure(PART, what, _flushes_per_s(folder), "1/s")


def _ours(folder: Path, environment: Mapping[str, str]) -> Sent:
    with LiveServer(folder, environment=environment) as server, signed_in(server) as desk:
        desk.add_forms_study(FORMS)
        port, pid = server.port, server.pid
        steadily, pausing = (tuple(desk.tablet_at_form() for _ in range(TABLETS)) for _ in range(2))
        paused = Plan("ours", port, pausing, FORMS_WITH_PAUSES, ITEMS, THINKING_S)
        return Sent(_run(Plan("ours", port, steadily, FORMS, ITEMS), pid), _run(paused, pid))


def compare(engine: str, sent: Sent, theirs: Submitted) -> Iterator[Figure]:
    """Compare the product, with data on disk when acknowledged, with oTree, with data in memory."""
    ours, peer = sent.steadily, f"oTree {VERSION}"
    rate, their_rate = (len(one.submits_s) / one.total_s for one in (ours, theirs))
    what = f"{TABLETS} tablets, {len(ours.submits_s)} forms of {ITEMS} statements"
    yield Figure(PART, f"{engine}: sent, next form got; {what}", rate, "1/s", peer, their_rate)
    times = rate / their_rate
    yield Figure(PART, f"{engine}: sent", times, "times oTree", "at least", TIMES_AS_MANY)
    for percent in (50, 95):
        mine, other = (1000 * np.percentile(one.submits_s, percent) for one in (ours, theirs))
        name = f"{engine}: sent to answered p{percent}"
        yield Figure(PART, name, float(mine), "ms", peer, float(other))
    cost_ms, their_cost_ms = (1000 * one.cpu_s / len(one.submits_s) for one in (ours, theirs))
    name = f"{engine}: server's processor time a form"
    yield Figure(PART, name, cost_ms, "ms", peer, their_cost_ms)
    p95_ms = 1000 * float(np.percentile(sent.with_pauses.submits_s, 95))
    name = f"{engine}: {THINKING_S:g} s of thinking before each form, sent to answered p95"
    yield Figure(PART, name, p95_ms, "ms", "limit", P95_LIMIT_MS)


def _flushes_per_s(folder: Path) -> float:
    """Return how often a second the disk of `folder` flushes what was appended to a file."""
    count, began_s = 0, time.perf_counter()
    with (folder / "flushed").open("wb", buffering=0) as file:
        while time.perf_counter() - began_s < FLUSHING_S:
            file.write(bytes(FLUSHED_BYTES))
            os.fdatasync(file.fileno())
            count += 1
    return count / (time.perf_counter() - began_s)


def _run(plan: Plan, server_pid: int) -> Submitted:
    before_s = _cpu_s(server_pid)
    done = subprocess.run(
        [sys.executable, "-m", "tests.benchmarks.session_desk.submitting"],
        cwd=Path(__file__).resolve().parents[3],
        input=f"{plan.as_json()}\n",
        capture_output=True,
        text=True,
        check=False,
        timeout=RUN_WITHIN_S,
    )
    if done.returncode != 0:
        raise RuntimeError(f"the tablets of {plan.server} failed:\n{done.stderr[-3000:]}")
    told = json.loads(done.stdout)
    cpu_s = _cpu_s(server_pid) - before_s
    return Submitted(tuple(told["submits_s"]), told["total_s"], cpu_s)


def _cpu_s(pid: int) -> float:
    """Return the processor time used so far by a server and its helper processes."""
    server = psutil.Process(pid)
    times = [one.cpu_times() for one in (server, *server.children(recursive=True))]
    return float(sum(one.user + one.system for one in times))
