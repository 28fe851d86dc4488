"""Measure dashboards and tests of large studies: response times, and how the cost grows.

Sessions are generated and marked simulated, six phases each. Parts:

    served   a real server with a thousand sessions: the first figures and all of them, group after
             group as a page requests them, of a server that was just started, with figures already
             drawn, and after another filter was chosen, which redraws them from cached tables
    growth   reading tables and drawing every figure, for 125 to 1,000 sessions; the exponent is the
             slope of log cost over log sessions: 1 is linear
    pandas   two figures compared with plain pandas and plotly on the exported CSV, in the same run
"""

import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import plotly.graph_objects as go
from scipy import stats
from sqlalchemy import update

from app.database import Database
from app.features.results.analysis.dashboard import dashboard_of
from app.features.results.analysis.figures import completions_drawing, embodiment_drawings
from app.features.results.analysis.material import Material, read_material
from app.features.results.analysis.tables import phases_table, scores_table
from app.features.results.exports.writing.cells import csv_pieces
from app.models import Participant, StudySession
from tests.benchmarks.report import Figure, Report
from tests.benchmarks.thousand import fill_thousand, shipped_database
from tests.features.builders import STUDY
from tests.support.server import ADMIN_PASSWORD, LiveServer

GROUPS = ("embodiment", "tasks", "movement", "answers", "demographics", "progress", "quality")
"""In the order of the page."""
PARTS = ("served", "growth", "pandas")
SESSIONS = 1000
SIZES = (125, 250, 500, 1000)
REPEATS, FILTERS, ROUNDS, BEST_OF = 25, 6, 5, 3
LIMIT_MS = 1000.0


def measure(parts: frozenset[str], duration_s: float | None = None) -> Report:
    """Measure the named parts."""
    report = Report("analysis")
    with tempfile.TemporaryDirectory(prefix="reembody-bench-") as scratch:
        folder = Path(scratch)
        if "served" in parts:
            report.add(*_served(folder / "served"))
        if "growth" in parts:
            report.add(*_growth(folder))
        if "pandas" in parts:
            report.add(*_beside_pandas(folder / "pandas"))
    return report


def _filled(data_dir: Path, sessions: int) -> Database:
    """Create a database with the given number of completed simulated sessions."""
    database = shipped_database(data_dir)
    fill_thousand(database, sessions)
    with database.writing() as db:
        for table in (StudySession, Participant):
            db.execute(update(table).values(kind="simulated"))
    return database


def _served(folder: Path) -> Iterator[Figure]:
    server = LiveServer(folder)
    _filled(server.data_dir, SESSIONS).close()
    path = f"/api/studies/{STUDY}/dashboard"
    with server, server.client() as client:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()

        def ask(group: str, **chosen: str) -> None:
            asked = {"kind": "simulated", "group": group, **chosen}
            client.get(path, params=asked, timeout=300.0).raise_for_status()

        def page(**chosen: str) -> tuple[float, ...]:
            # In the order of the page: each group is requested when the one above it has arrived.
            return tuple(_took_ms(partial(ask, group, **chosen)) for group in GROUPS)

        cold = page()
        yield Figure("served", "first figures, cold", cold[0], "ms")
        yield Figure("served", "all figures, cold", sum(cold), "ms")
        kept = [_took_ms(lambda: ask(GROUPS[0])) for _ in range(REPEATS)]
        yield Figure("served", "figures p95, warm", _p95(kept), "ms", "limit", LIMIT_MS)
        days = pd.date_range("2026-03-02", periods=FILTERS)
        fresh = [page(since=day.date().isoformat()) for day in days]
        first = [times[0] for times in fresh]
        yield Figure(
            "served", "first figures of a filter, p95", _p95(first), "ms", "limit", LIMIT_MS
        )
        for at, group in enumerate(GROUPS[1:], start=1):
            median = float(np.median([times[at] for times in fresh]))
            yield Figure("served", f"then its {group}, median", median, "ms")
        every = float(np.median([sum(times) for times in fresh]))
        yield Figure("served", "all figures of a filter, median", every, "ms")


def _growth(folder: Path) -> Iterator[Figure]:
    read_s, drawn_s = [], []
    for sessions in SIZES:
        database = _filled(folder / str(sessions), sessions)
        # The best of a few runs: other load on the machine only adds time.
        read, drawn = partial(_material, database), partial(dashboard_of, _material(database))
        read_s.append(min(_took_ms(read) for _ in range(BEST_OF)) / 1e3)
        drawn_s.append(min(_took_ms(drawn) for _ in range(BEST_OF)) / 1e3)
        database.close()
        yield Figure("growth", f"tables of {sessions} sessions", read_s[-1], "s")
        yield Figure("growth", f"all figures of {sessions} sessions", drawn_s[-1], "s")
    for name, cost_s in (("tables", read_s), ("figures", drawn_s)):
        slope = float(np.polyfit(np.log(SIZES), np.log(cost_s), 1)[0])
        yield Figure("growth", f"exponent of {name}", slope, "", "linear", 1.0)


def _beside_pandas(folder: Path) -> Iterator[Figure]:
    database = _filled(folder, SESSIONS)
    with database.reading() as db:
        tables = {
            "scores": scores_table(db, STUDY, "simulated"),
            "phases": phases_table(db, STUDY, "simulated"),
        }
    for name, table in tables.items():
        (folder / f"{name}.csv").write_bytes(b"".join(csv_pieces(name, table)))
    material = _material(database)
    database.close()
    for figure, ours, theirs in (
        (
            "agency",
            lambda: [one.as_json() for one in embodiment_drawings(_agency(material))],
            lambda: _plain(folder / "scores.csv", "value", score="agency"),
        ),
        (
            "completions",
            lambda: completions_drawing(material.counting(material.phases)).as_json(),
            lambda: _plain(folder / "phases.csv", "completions", phase_kind="task"),
        ),
    ):
        own = float(np.median([_took_ms(ours) for _ in range(ROUNDS)]))
        plain = float(np.median([_took_ms(theirs) for _ in range(ROUNDS)]))
        yield Figure("pandas", f"{figure}, tables kept", own, "ms", "pandas over CSV", plain)


def _agency(material: Material) -> pd.DataFrame:
    scores = material.counting(material.scores)
    return scores[scores["score"] == "agency"]


def _plain(path: Path, value: str, **rows: str) -> str:
    """Compute the same lines, means and intervals as in a notebook with plain pandas."""
    frame = pd.read_csv(path)
    frame = frame[frame["valid"] & frame["limb"].notna()]
    for column, wanted in rows.items():
        frame = frame[frame[column] == wanted]
    keys = ["participant_code", "limb", "latency_ms"]
    values = frame.groupby(keys)[value].mean().reset_index()
    figure = go.Figure()
    for _, line in values.groupby(["limb", "participant_code"]):
        trace: dict[str, Any] = {"type": "scatter", "x": line["latency_ms"], "y": line[value]}
        figure.add_trace(trace)
    for limb, own in values.groupby("limb"):
        cells = own.groupby("latency_ms")[value].agg(["mean", "std", "count"])
        half = stats.t.ppf(0.975, cells["count"] - 1) * cells["std"] / np.sqrt(cells["count"])
        figure.add_trace(
            go.Scatter(x=cells.index, y=cells["mean"], error_y={"array": half}, name=str(limb))
        )
    return str(figure.to_json())


def _material(database: Database) -> Material:
    with database.reading() as db:
        return read_material(db, STUDY, "simulated")


def _took_ms(call: Callable[[], object]) -> float:
    began_s = time.perf_counter()
    call()
    return 1000.0 * (time.perf_counter() - began_s)


def _p95(times_ms: list[float]) -> float:
    return float(np.percentile(times_ms, 95))
