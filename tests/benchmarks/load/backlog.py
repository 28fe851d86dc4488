"""Measure a headset that reconnects with ten minutes in its journal while all others stream."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from tests.benchmarks.load.figures import (
    ACK_LIMIT_MS,
    CONSOLE_LIMIT_MS,
    MIB,
    ack_ms,
    live_age_ms,
    safety,
)
from tests.benchmarks.load.lab import Lab, call_phases, make_lab
from tests.benchmarks.load.movement import RATE_HZ
from tests.benchmarks.load.plans import Load, stream_url
from tests.benchmarks.load.processes import Companion
from tests.benchmarks.load.returning import ReturnPlan
from tests.benchmarks.load.scenario import (
    Outcome,
    Store,
    database_url,
    live_server,
    outcome_of,
    run_course,
)
from tests.benchmarks.report import Figure
from tests.support.server import LiveServer

SESSIONS = 50
LASTS_S, COMES_BACK_S = 75.0, 10.0
AWAY_S = 600.0
DRAIN_LIMIT_S = 60.0


@dataclass(frozen=True)
class Backlog:
    """The results of a load in which one headset reconnected; `told` is its own report."""

    outcome: Outcome
    told: dict[str, Any]
    away_s: float


def backlog_figures(part: str, folder: Path, duration_s: float) -> Iterator[Figure]:
    """Measure how fast the journal drains, and how it affects the others."""
    found = run_backlog(folder, min(duration_s, LASTS_S))
    told, others = found.told, SESSIONS - 1
    took_s = told["drained_s"] - told["back_s"]
    words = f"{found.away_s:g} s in the journal ({told['messages']:,} messages)"
    if not told["is_drained"]:
        words = f"given up before all were drained: {words}"
    yield Figure(part, f"drained: {words}", took_s, "s", "limit", DRAIN_LIMIT_S)
    yield Figure(part, "drained per second", told["messages"] / took_s, "messages/s")
    yield Figure(part, "drained per second", told["size_bytes"] / MIB / took_s, "MiB/s")
    yield Figure(part, "real time caught up", found.away_s / took_s, "s/s")
    yield Figure(part, "CPU of the one who drains", 100 * told["cpu_s"] / took_s, "% of a core")
    during = _meanwhile(found)
    p50, p99, most = np.percentile(ack_ms(during), [50, 99, 100])
    yield Figure(part, f"meanwhile durable ack p50 of the other {others}", float(p50), "ms")
    yield Figure(
        part,
        f"meanwhile durable ack p99 of the other {others}",
        float(p99),
        "ms",
        "limit",
        ACK_LIMIT_MS,
    )
    yield Figure(part, "meanwhile durable ack max of the others", float(most), "ms")
    yield from _consoles(part, found)
    yield from safety(part, found.outcome)


def run_backlog(folder: Path, duration_s: float) -> Backlog:
    """Start all headsets, and later one more with a journal proportional to the run."""
    away_s = AWAY_S * min(1.0, duration_s / LASTS_S)
    load = Load(sessions=SESSIONS - 1, duration_s=duration_s)
    server = live_server(folder, Store())
    with server:
        lab = make_lab(server, SESSIONS)
        one = Lab(lab.seats[-1:], lab.cookies)
        guest = Companion.start(
            "load.returning", _plan(folder, server, one, away_s, duration_s), folder / "returning"
        )
        with guest:
            guest.wait_for("connected")
            call_phases(server, one)
            guest.wait_for("ready")
            others = Lab(lab.seats[:-1], lab.cookies)
            course = run_course(folder, server, others, load, Store(), [guest])
            told = guest.result()
    url = database_url(server, Store())
    return Backlog(outcome_of(folder, load, course, url, [told]), told, away_s)


def _plan(
    folder: Path, server: LiveServer, lab: Lab, away_s: float, duration_s: float
) -> ReturnPlan:
    seat = lab.seats[0]
    return ReturnPlan(
        url=stream_url(server),
        session_id=seat.session_id,
        token=seat.token,
        journal=str(folder / "journal"),
        # Whole messages of six frames.
        frames=int(away_s * RATE_HZ / 6) * 6,
        comes_back_s=COMES_BACK_S * duration_s / LASTS_S,
        gives_up_s=2 * DRAIN_LIMIT_S,
    )


def _meanwhile(found: Backlog) -> Outcome:
    """Return the run with only the others' messages that were sent while the journal drained."""
    handed_s = found.outcome.messages[:, 2]
    inside = (handed_s >= found.told["back_s"]) & (handed_s <= found.told["drained_s"])
    return replace(found.outcome, messages=found.outcome.messages[inside])


def _consoles(part: str, found: Backlog) -> Iterator[Figure]:
    """Yield the figures of the consoles that were open while the journal drained."""
    back_s, drained_s = found.told["back_s"], found.told["drained_s"]
    news, views = found.outcome.news, found.outcome.views
    ages_ms = live_age_ms(found.outcome)[(news[:, 2] >= back_s) & (news[:, 2] <= drained_s)]
    waits_ms = 1000 * views[(views[:, 0] >= back_s) & (views[:, 0] <= drained_s), 1]
    for name, values_ms in (("age of live figures", ages_ms), ("session view", waits_ms)):
        # A journal that drains immediately leaves nothing to measure.
        if len(values_ms):
            p95 = float(np.percentile(values_ms, 95))
            name = f"meanwhile console: {name} p95 of {len(values_ms)}"
            yield Figure(part, name, p95, "ms", "limit", CONSOLE_LIMIT_MS)
