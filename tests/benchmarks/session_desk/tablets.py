"""Measure sixteen tablets that submit fourteen statements at full speed, here and in oTree."""

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import psutil

from tests.benchmarks.peers.otree import VERSION, running_otree
from tests.benchmarks.report import Figure
from tests.benchmarks.session_desk.site import ITEMS, Desk, signed_in, statements
from tests.benchmarks.session_desk.submitting import Plan, Submitted
from tests.support.server import LiveServer

PART = "tablets"
TABLETS, FORMS = 16, 20
P95_LIMIT_MS, TIMES_AS_MANY = 100.0, 5.0
RUN_WITHIN_S = 300.0


def figures(folder: Path) -> Iterator[Figure]:
    """Measure both systems one after the other, on the same machine with the same clients."""
    with LiveServer(folder / "ours") as server, signed_in(server) as desk:
        ours = _ours(desk)
    with running_otree(folder / "otree", statements(), TABLETS, FORMS) as otree:
        who = tuple(otree.first_page(at) for at in range(TABLETS))
        theirs = _run(Plan("otree", otree.port, who, FORMS, ITEMS), otree.pid)
    yield from compare(ours, theirs)


def _ours(desk: Desk) -> Submitted:
    desk.add_forms_study(FORMS)
    who = tuple(desk.tablet_at_form() for _ in range(TABLETS))
    return _run(Plan("ours", desk.server.port, who, FORMS, ITEMS), desk.server.pid)


def compare(ours: Submitted, theirs: Submitted) -> Iterator[Figure]:
    """Compare the product, with data on disk when acknowledged, with oTree, with data in memory."""
    peer = f"oTree {VERSION}"
    rate, their_rate = (len(one.submits_s) / one.total_s for one in (ours, theirs))
    what = f"{TABLETS} tablets, {len(ours.submits_s)} forms of {ITEMS} statements"
    yield Figure(PART, f"submitted, next form fetched; {what}", rate, "1/s", peer, their_rate)
    yield Figure(PART, "submitted", rate / their_rate, "times oTree", "at least", TIMES_AS_MANY)
    for percent in (50, 95):
        mine, other = (1000 * np.percentile(one.submits_s, percent) for one in (ours, theirs))
        yield Figure(PART, f"sent to answered p{percent}", float(mine), "ms", peer, float(other))
    cost_ms, their_cost_ms = (1000 * one.cpu_s / len(one.submits_s) for one in (ours, theirs))
    yield Figure(PART, "server's processor time a form", cost_ms, "ms", peer, their_cost_ms)
    p95_ms = 1000 * float(np.percentile(ours.submits_s, 95))
    yield Figure(PART, "sent to answered p95", p95_ms, "ms", "limit", P95_LIMIT_MS)


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
