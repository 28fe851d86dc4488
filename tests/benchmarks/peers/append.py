"""Measure the bare disk: the same bytes appended to a file and synced at the commit interval."""

import os
import sqlite3
import time
from collections.abc import Callable, Iterator
from itertools import repeat
from pathlib import Path

import numpy as np

from app.wire.batch import HEADER_BYTES, VALUES_PER_FRAME, body_bytes
from tests.benchmarks.load.figures import MIB
from tests.benchmarks.load.movement import RATE_HZ
from tests.benchmarks.load.streaming import FRAMES_PER_BATCH
from tests.benchmarks.peers.ours import Ours
from tests.benchmarks.report import Figure

SESSIONS = 50
COMMIT_S = 0.05
MESSAGES_PER_S = SESSIONS * 2 * RATE_HZ / FRAMES_PER_BATCH
MESSAGE_BYTES = HEADER_BYTES + body_bytes(FRAMES_PER_BATCH, VALUES_PER_FRAME)
CHUNKS_PER_MINUTE = 2 * 60


def append_figures(part: str, folder: Path, ours: Ours, duration_s: float) -> Iterator[Figure]:
    """Measure latency at the rate of 50 sessions, and the one-second chunks written per second."""
    folder.mkdir(parents=True)
    waits_ms = 1000 * _latencies(folder / "messages", duration_s)
    peer = "append + fsync every 50 ms"
    for name, value, at in (
        ("durable ack p50", ours.ack_p50_ms, 50),
        ("durable ack p99", ours.ack_p99_ms, 99),
    ):
        yield Figure(part, name, value, "ms", peer, float(np.percentile(waits_ms, at)))
    each_s = duration_s / 4
    # A second of a stream as our server stores it, folded.
    size_bytes = int(ours.mib_per_minute * MIB / CHUNKS_PER_MINUTE)
    rng = np.random.default_rng(2)
    for together in (1, 2 * SESSIONS):
        chunks = [rng.bytes(size_bytes) for _ in range(together)]
        name = f"one-second chunks, {together} to a commit: SQLite FULL"
        rows = _chunks_per_s(_into_rows(folder / f"{together}.sqlite"), chunks, each_s)
        file = _chunks_per_s(_into_file(folder / f"{together}"), chunks, each_s)
        yield Figure(part, name, rows, "1/s", "append + fsync", file)


def _latencies(path: Path, duration_s: float) -> "np.typing.NDArray[np.float64]":
    """Return, for each message, the time from when it is due until it is synced.

    A message waits for the end of its interval, then for the disk. Messages are evenly spaced; the
    interval after one in which the disk was slow begins late.
    """
    payload = np.random.default_rng(1).bytes(MESSAGE_BYTES)
    due_s = np.arange(int(duration_s * MESSAGES_PER_S)) / MESSAGES_PER_S
    synced_s = np.full(len(due_s), np.nan)
    done = 0
    with path.open("ab", buffering=0) as file:
        began_s = time.monotonic()
        while done < len(due_s):
            time.sleep(COMMIT_S)
            arrived = int(np.searchsorted(due_s, time.monotonic() - began_s))
            file.write(b"".join(repeat(payload, arrived - done)))
            os.fsync(file.fileno())
            synced_s[done:arrived] = time.monotonic() - began_s
            done = arrived
    waits_s: np.typing.NDArray[np.float64] = synced_s - due_s
    return waits_s


def _chunks_per_s(
    commit: Callable[[list[bytes]], None], chunks: list[bytes], duration_s: float
) -> float:
    """Return the chunks per second at full speed, with a fixed number per commit."""
    began_s, commits = time.monotonic(), 0
    while time.monotonic() - began_s < duration_s:
        commit(chunks)
        commits += 1
    return commits * len(chunks) / (time.monotonic() - began_s)


def _into_file(path: Path) -> Callable[[list[bytes]], None]:
    file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND)

    def commit(chunks: list[bytes]) -> None:
        os.write(file, b"".join(chunks))
        os.fsync(file)

    return commit


def _into_rows(path: Path) -> Callable[[list[bytes]], None]:
    """Measure the same data inserted into a table like the product's, with the same settings."""
    database = sqlite3.connect(path, isolation_level=None)
    database.execute("PRAGMA journal_mode = WAL")
    database.execute("PRAGMA synchronous = FULL")
    database.execute("CREATE TABLE chunks (id INTEGER PRIMARY KEY, data BLOB)")

    def commit(chunks: list[bytes]) -> None:
        database.execute("BEGIN IMMEDIATE")
        database.executemany("INSERT INTO chunks (data) VALUES (?)", [(one,) for one in chunks])
        database.execute("COMMIT")

    return commit
