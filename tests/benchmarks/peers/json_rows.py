"""Measure one JSON record per joint sample, each in its own row and commit, as in XRXP."""

import sqlite3
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.wire.batch import BODY_JOINTS
from tests.benchmarks.load.figures import MIB
from tests.benchmarks.load.processes import Companion
from tests.benchmarks.peers.json_client import JsonClientPlan
from tests.benchmarks.peers.json_server import JsonServerPlan, open_records
from tests.benchmarks.peers.ours import (
    DOWN_S,
    SAMPLES_PER_MINUTE,
    SAMPLES_PER_SESSION_S,
    Ours,
)
from tests.benchmarks.report import Figure
from tests.support.server import free_port

PEER = "JSON rows"


@dataclass(frozen=True)
class Bench:
    """The folder and the port of one run of the peer."""

    folder: Path
    port: int

    @property
    def database(self) -> Path:
        """Return the path of the database."""
        return self.folder / "records.sqlite"

    def server(self) -> Companion:
        """Start the peer's server and wait until it listens."""
        plan = JsonServerPlan(self.port, str(self.database))
        made = Companion.start("peers.json_server", plan, self.folder / "server")
        made.wait_for("ready")
        return made

    def client(self, records_per_s: float | None, duration_s: float) -> Companion:
        """Start the peer's client."""
        url = f"ws://127.0.0.1:{self.port}"
        plan = JsonClientPlan(url, BODY_JOINTS, records_per_s, duration_s)
        return Companion.start("peers.json_client", plan, self.folder / "client")


def json_figures(part: str, folder: Path, ours: Ours, duration_s: float) -> Iterator[Figure]:
    """Measure the peer at saturation, at half of that rate, and with a killed server."""
    full = _run(_bench(folder / "full"), None, duration_s)
    rate, cores = full["stored"] / full["wall_s"], full["cpu_s"] / full["wall_s"]
    yield Figure(part, "joint samples", ours.samples_per_s, "1/s", f"{PEER}, saturated", rate)
    yield Figure(part, "joint samples per core", ours.samples_per_core_s, "1/s", PEER, rate / cores)
    mib = full["bytes"] / full["stored"] * SAMPLES_PER_MINUTE / MIB
    name = "stored per session-minute"
    yield Figure(part, name, ours.mib_per_minute, "MiB", f"{PEER}, extrapolated", mib)
    half = _run(_bench(folder / "half"), rate / 2, duration_s / 2)
    words = f"{PEER} at {rate / 2:.0f} samples/s, row committed"
    yield Figure(
        part,
        "delivery p99 (ours: durable and acknowledged)",
        ours.ack_p99_ms,
        "ms",
        words,
        1000 * half["p99_s"],
    )
    sent, stored = _killed(_bench(folder / "killed"), duration_s)
    name = f"{PEER} at kill -9, one session's rate: sent and lost"
    yield Figure(part, name, sent - stored, "joint samples", "of", sent)


def _bench(folder: Path) -> Bench:
    folder.mkdir(parents=True)
    return Bench(folder, free_port())


def _run(bench: Bench, records_per_s: float | None, duration_s: float) -> dict[str, Any]:
    """Send records for a given time; return the server's counters and the size of its file."""
    with bench.server() as server, bench.client(records_per_s, duration_s) as client:
        client.result()
        _settle(bench.database)
        server.begin(0.0)
        told = server.result()
    return {**told, "bytes": bench.database.stat().st_size}


def _killed(bench: Bench, duration_s: float) -> tuple[int, int]:
    """Kill the server in mid-run and restart it; return the numbers of sent and stored records."""
    with bench.server() as server, bench.client(SAMPLES_PER_SESSION_S, duration_s) as client:
        time.sleep(duration_s / 2)
        server.end()
        time.sleep(DOWN_S)
        with bench.server() as again:
            sent = int(client.result()["sent"])
            _settle(bench.database)
            again.begin(0.0)
            again.result()
    return sent, _count(bench.database)


def _settle(path: Path) -> None:
    """Wait until nothing more arrives: records in the socket buffers are still stored."""
    before = -1
    while (now := _count(path)) != before:
        before = now
        time.sleep(0.5)


def _count(path: Path) -> int:
    database: sqlite3.Connection = open_records(str(path))
    try:
        return int(database.execute("SELECT count(*) FROM records").fetchone()[0])
    finally:
        database.close()
