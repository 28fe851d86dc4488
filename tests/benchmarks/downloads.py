"""Measure an export file: memory while it is created and fetched, effect on others, duration.

Twelve simulated sessions as long as real ones (9.4 min at 90 Hz), about a gigabyte of CSV. Memory
is the resident size reported by the system; growth is the end minus a quarter of the way, so a
process that kept its output in memory would show hundreds of MiB.
"""

import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx2
import numpy as np
import psutil
from sqlalchemy import Table, insert, literal, select, update

from app.database import Base, Database
from app.models import TelemetryStream
from app.wire import BODY_STREAMS
from tests.benchmarks.headsets import FRAMES_PER_BATCH, movement
from tests.benchmarks.report import Figure, Report
from tests.benchmarks.thousand import shipped_database
from tests.features.builders import STUDY, SessionSpec, build_session
from tests.features.movement_builders import store_chunks
from tests.support.server import ADMIN_PASSWORD, LiveServer

PARTS = ("making", "fetching", "cancelling")
SESSIONS = 12
FRAMES = 50_880
PHASES = 7
MIB = 2**20
LOOK_EVERY_S = 0.25
GROWTH_LIMIT_MIB = 32.0
WRITE_LIMIT_MS = 100.0


@dataclass
class Looks:
    """Samples taken while a file was created: its completed share and the resident bytes."""

    share: list[float] = field(default_factory=list)
    server: list[int] = field(default_factory=list)
    maker: list[int] = field(default_factory=list)
    write_ms: list[float] = field(default_factory=list)


def measure(parts: frozenset[str], duration_s: float | None = None) -> Report:
    """Measure the creation and the download of an export file on a real server."""
    report = Report("downloads")
    with tempfile.TemporaryDirectory(prefix="reembody-bench-") as scratch:
        server = LiveServer(Path(scratch))
        _fill(server)
        with server, server.client() as client:
            client.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD})
            if "cancelling" in parts:
                report.add(*_cancelling(server, client))
            if not parts & {"making", "fetching"}:
                return report
            looks, done = _made(server, client)
            if "making" in parts:
                report.add(*_making(looks, done))
            if "fetching" in parts:
                report.add(*_fetching(server, client, done))
    return report


def _fill(server: LiveServer) -> None:
    database = shipped_database(server.data_dir)
    with database.writing() as db:
        first = build_session(db, SessionSpec("SIM-01", kind="simulated"))
        pieces = [movement(seed)[:-FRAMES_PER_BATCH] for seed in range(-(-FRAMES // 900))]
        values = np.concatenate(pieces)[:FRAMES]
        for stream in BODY_STREAMS:
            for phase, seqs in enumerate(np.array_split(np.arange(FRAMES), PHASES), start=1):
                rows = values[seqs[0] : seqs[-1] + 1]
                store_chunks(db, first.id, stream, seqs.tolist(), rows, phase_id=phase)
        db.execute(update(TelemetryStream).values(frames_stored=FRAMES))
    for number in range(1, SESSIONS):
        _copy(database, first.id, f"SIM-{number + 1:02}")
    database.close()


def _copy(database: Database, source: str, code: str) -> None:
    """Create a session with a copy of another's movement, copied within the database."""
    with database.writing() as db:
        session = build_session(db, SessionSpec(code, kind="simulated"))
        for name in ("telemetry_streams", "telemetry_chunks"):
            table: Table = Base.metadata.tables[name]
            columns = [
                literal(session.id) if column.name == "session_id" else column
                for column in table.columns
            ]
            rows = select(*columns).where(table.c.session_id == source)
            db.execute(insert(table).from_select(list(table.columns.keys()), rows))


def _order(client: httpx2.Client, kind: str) -> dict[str, Any]:
    answer = client.post(f"/api/studies/{STUDY}/exports", json={"kind": kind})
    ordered: dict[str, Any] = answer.raise_for_status().json()
    return ordered


def _cancelling(server: LiveServer, client: httpx2.Client) -> Iterator[Figure]:
    ordered = _order(client, "simulated")
    view = ordered
    while view["rows"] == 0:
        time.sleep(LOOK_EVERY_S)
        view = client.get(f"/api/exports/{ordered['id']}").json()
    makers = _children(server)
    began_s = time.monotonic()
    client.delete(f"/api/exports/{ordered['id']}").raise_for_status()
    took_ms = 1000 * (time.monotonic() - began_s)
    yield Figure("cancelling", "until process and files are gone", took_ms, "ms")
    alive = sum(process.is_running() for process in makers)
    left = list((server.data_dir / "scratch" / "exports").iterdir())
    yield Figure("cancelling", "processes left", alive, "")
    yield Figure("cancelling", "files left", len(left), "")


def _made(server: LiveServer, client: httpx2.Client) -> tuple[Looks, dict[str, Any]]:
    """Have the export file created while sampling memory and occasionally storing something."""
    looks, process = Looks(), psutil.Process(server.pid)
    ordered = view = _order(client, "simulated")
    while view["state"] in ("queued", "making"):
        time.sleep(LOOK_EVERY_S)
        began_s = time.monotonic()
        client.post(f"/api/studies/{STUDY}/sessions", json={"kind": "test"}).raise_for_status()
        looks.write_ms.append(1000 * (time.monotonic() - began_s))
        view = client.get(f"/api/exports/{ordered['id']}").json()
        sizes = [_resident(child) for child in _children(server)]
        if view["state"] == "making" and view["rows"] and sizes:
            looks.share.append(view["rows"] / max(1, view["rows_total"]))
            looks.server.append(process.memory_info().rss)
            looks.maker.append(max(sizes))
    if view["state"] != "ready":
        raise RuntimeError(f"the export failed: {view['trouble']}")
    return looks, view


def _making(looks: Looks, done: dict[str, Any]) -> Iterator[Figure]:
    part = "making"
    yield Figure(part, f"ZIP of {SESSIONS} sessions", done["bytes"] / MIB, "MiB")
    yield Figure(part, "rows of 187 columns", done["rows"] / done["elapsed_s"], "1/s")
    late = np.array(looks.share) >= 0.25
    for who, sizes in (("its process", looks.maker), ("the server", looks.server)):
        seen = np.array(sizes)[late] / MIB
        yield Figure(part, f"{who}, most", float(np.max(seen)), "MiB")
        growth = float(np.median(seen[-5:]) - np.median(seen[:5]))
        yield Figure(part, f"{who} grows by", growth, "MiB", "limit", GROWTH_LIMIT_MIB)
    p95 = float(np.percentile(looks.write_ms, 95))
    yield Figure(part, "a session stored meanwhile, p95", p95, "ms", "limit", WRITE_LIMIT_MS)


def _fetching(server: LiveServer, client: httpx2.Client, done: dict[str, Any]) -> Iterator[Figure]:
    process, path = psutil.Process(server.pid), f"/api/exports/{done['id']}/file"
    before, most, size = process.memory_info().rss, 0, 0
    began_s = time.monotonic()
    with client.stream("GET", path) as answer:
        for piece in answer.iter_bytes(MIB):
            size += len(piece)
            most = max(most, process.memory_info().rss)
    took_s = time.monotonic() - began_s
    yield Figure("fetching", "rate", size / MIB / took_s, "MiB/s")
    growth = (most - before) / MIB
    yield Figure("fetching", "the server grows by", growth, "MiB", "limit", GROWTH_LIMIT_MIB)
    with client.stream("GET", path, headers={"range": f"bytes={size - 1000}-"}) as answer:
        rest = len(answer.read())
    yield Figure("fetching", "bytes after breaking off 1000 before the end", rest, "")


def _children(server: LiveServer) -> list[psutil.Process]:
    """Return the server's computing processes, without Python's own helper."""
    children = psutil.Process(server.pid).children(recursive=True)
    return [child for child in children if "spawn_main" in " ".join(_command(child))]


def _command(process: psutil.Process) -> list[str]:
    try:
        return list(process.cmdline())
    except psutil.NoSuchProcess:
        return []


def _resident(process: psutil.Process) -> int:
    try:
        return int(process.memory_info().rss)
    except psutil.NoSuchProcess:
        return 0
