"""Measure an export file: duration, memory while it is created and fetched, effect on others.

Twelve simulated sessions as long as real ones (9.4 min at 90 Hz), about a gigabyte of CSV. Memory
is the resident size reported by the system; growth is the end minus a quarter of the way, so a
process that kept its output in memory would show hundreds of MiB.

Parts: `making` the file with its movement, compared with DuckDB, which writes the arrays of one
session as CSV from memory; `tables` alone; `beside`, the acknowledgements of a session that
streams while the file is made, compared with those on an idle server; `fetching`; `cancelling`.
"""

import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx2
import numpy as np
import psutil
from numpy.typing import NDArray
from sqlalchemy import Table, insert, literal, select, update

from app.database import Base, Database
from app.models import TelemetryStream
from app.wire import BODY_STREAMS
from tests.benchmarks.acknowledgement import paired_headset, stream
from tests.benchmarks.headsets import FRAMES_PER_BATCH, movement
from tests.benchmarks.peers.duckdb_csv import seconds_to_write
from tests.benchmarks.report import Figure, Report
from tests.benchmarks.thousand import shipped_database
from tests.features.builders import STUDY, SessionSpec, build_session
from tests.features.movement_builders import store_chunks
from tests.support.server import ADMIN_PASSWORD, LiveServer

PARTS = ("making", "tables", "beside", "fetching", "cancelling")
COMMAND = (sys.executable, "-m", "app.cli")
"""The server as a process of its own, whose workers are its children."""
SESSIONS = 12
FRAMES, COLUMNS = 50_880, 187
PHASES = 7
MIB = 2**20
LOOK_EVERY_S = 0.25
GROWTH_LIMIT_MIB = 32.0
WRITE_LIMIT_MS = 100.0
TABLES_LIMIT_S = 3.0
DUCKDB_SHARE = 0.5
BESIDE_LIMIT = 1.5
STREAMED_S, STARTING_S = 14.0, 2.0
"""How long a headset streams, and the beginning of that, which does not count."""


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
        server = LiveServer(Path(scratch), command=COMMAND)
        _fill(server)
        with server, server.client() as client:
            client.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD})
            if "cancelling" in parts:
                report.add(*_cancelling(server, client))
            if "tables" in parts:
                report.add(*_tables(client))
            if "beside" in parts:
                report.add(*_beside(server, client))
            if not parts & {"making", "fetching"}:
                return report
            looks, done = _made(server, client)
            if "making" in parts:
                report.add(*_making(looks, done))
                report.add(*_duckdb(Path(scratch), done))
            if "fetching" in parts:
                report.add(*_fetching(server, client, done))
    return report


def _fill(server: LiveServer) -> None:
    database = shipped_database(server.data_dir)
    with database.writing() as db:
        first = build_session(db, SessionSpec("SIM-01", kind="simulated"))
        values = _frames()
        for stream in BODY_STREAMS:
            for phase, seqs in enumerate(np.array_split(np.arange(FRAMES), PHASES), start=1):
                rows = values[seqs[0] : seqs[-1] + 1]
                store_chunks(db, first.id, stream, seqs.tolist(), rows, phase_id=phase)
        db.execute(update(TelemetryStream).values(frames_stored=FRAMES))
    for number in range(1, SESSIONS):
        _copy(database, first.id, f"SIM-{number + 1:02}")
    database.close()


def _frames() -> NDArray[np.float32]:
    """Return smooth movement of a session's length, (FRAMES, 91)."""
    pieces = [movement(seed)[:-FRAMES_PER_BATCH] for seed in range(-(-FRAMES // 900))]
    return np.concatenate(pieces)[:FRAMES]


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


def _order(client: httpx2.Client, *, movement: bool = True) -> dict[str, Any]:
    wish = {"kind": "simulated", "movement": movement}
    answer = client.post(f"/api/studies/{STUDY}/exports", json=wish)
    ordered: dict[str, Any] = answer.raise_for_status().json()
    return ordered


def _writing(client: httpx2.Client) -> dict[str, Any]:
    """Order an export with movement; return it once its first rows are written."""
    view = ordered = _order(client)
    while view["rows"] == 0:
        time.sleep(LOOK_EVERY_S)
        view = client.get(f"/api/exports/{ordered['id']}").json()
    return ordered


def _tables(client: httpx2.Client) -> Iterator[Figure]:
    began_s = time.monotonic()
    view = _order(client, movement=False)
    while view["state"] in ("queued", "making"):
        time.sleep(0.05)
        view = client.get(f"/api/exports/{view['id']}").json()
    took_s = time.monotonic() - began_s
    if view["state"] != "ready":
        raise RuntimeError(f"the export failed: {view['trouble']}")
    client.delete(f"/api/exports/{view['id']}").raise_for_status()
    yield Figure("tables", f"of {SESSIONS} sessions", took_s, "s", "limit", TABLES_LIMIT_S)


def _beside(server: LiveServer, client: httpx2.Client) -> Iterator[Figure]:
    idle_ms = _acknowledged_ms(server)
    with ThreadPoolExecutor(1) as pool:
        ordered = _writing(client)
        streaming = pool.submit(_acknowledged_ms, server)
        while not streaming.done():
            time.sleep(LOOK_EVERY_S)
            view = client.get(f"/api/exports/{ordered['id']}").json()
            if view["state"] == "ready":
                client.delete(f"/api/exports/{ordered['id']}").raise_for_status()
                ordered = _order(client)
        beside_ms = streaming.result()
    client.delete(f"/api/exports/{ordered['id']}").raise_for_status()
    (idle_p50, idle_p99), (p50, p99) = (
        np.percentile(one, [50, 99]).tolist() for one in (idle_ms, beside_ms)
    )
    peer = "nothing being exported"
    yield Figure("beside", "acknowledgement p50", p50, "ms", peer, idle_p50)
    yield Figure("beside", "acknowledgement p99", p99, "ms", peer, idle_p99)
    yield Figure("beside", "p99 over that of idle", p99 / idle_p99, "", "limit", BESIDE_LIMIT)


def _acknowledged_ms(server: LiveServer) -> NDArray[np.float64]:
    """Stream one headset; return the milliseconds from each message to its acknowledgement."""
    told = stream(server, [paired_headset(server)], STREAMED_S)
    return np.array([1000 * latency_s for sent_s, latency_s in told if sent_s >= STARTING_S])


def _duckdb(folder: Path, done: dict[str, Any]) -> Iterator[Figure]:
    """Have DuckDB write the columns of one session's samples, and compare the rows a second."""
    values = _frames()
    head = np.zeros((FRAMES, COLUMNS - 2 * values.shape[1]), np.float32)
    np.save(folder / "session.npy", np.concatenate((head, values, values), axis=1))
    took_s = seconds_to_write(folder / "session.npy", folder / "session.csv")
    ours, theirs = done["rows"] / done["elapsed_s"], FRAMES / took_s
    peer = "DuckDB, arrays in memory, not compressed"
    yield Figure("making", "rows, as a ZIP", ours, "1/s", peer, theirs)
    yield Figure(
        "making", "share of DuckDB's rows a second", ours / theirs, "", "at least", DUCKDB_SHARE
    )


def _cancelling(server: LiveServer, client: httpx2.Client) -> Iterator[Figure]:
    others = set(_children(server))
    ordered = _writing(client)
    makers = set(_children(server)) - others
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
    ordered = view = _order(client)
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
    yield Figure(part, "duration", done["elapsed_s"], "s")
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
