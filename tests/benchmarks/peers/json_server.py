"""Store one JSON record per joint sample: `python -m tests.benchmarks.peers.json_server`.

The server stores data as XRXP's recorder sends them: a WebSocket text message contains one record
of one object's pose; nothing is acknowledged. Every message is committed individually, to SQLite
with synchronous FULL. Prints `ready`, serves until a line arrives on standard input, then prints
its counters.
"""

import asyncio
import json
import sqlite3
import sys
import time
from array import array
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
import uvloop
from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import ConnectionClosed

INSERT = "INSERT INTO records (session, stream, joint, seq, t_s, record) VALUES (?, ?, ?, ?, ?, ?)"


@dataclass(frozen=True)
class JsonServerPlan:
    """The port and the database of the server."""

    port: int
    database: str

    def as_json(self) -> str:
        """Return the plan as one line of JSON."""
        return json.dumps(asdict(self))


@dataclass
class Recorder:
    """The only writer; `latency_s` is the time from creating a record until it is committed."""

    database: sqlite3.Connection
    latency_s: "array[float]" = field(default_factory=lambda: array("d"))
    began: tuple[float, float] | None = None
    ended: tuple[float, float] = (0.0, 0.0)

    async def take(self, socket: ServerConnection) -> None:
        """Store the records of one headset."""
        try:
            async for text in socket:
                self.store(str(text))
        except ConnectionClosed:
            return

    def store(self, text: str) -> None:
        """Store one record in its own row and commit."""
        if self.began is None:
            self.began = time.process_time(), time.monotonic()
        record = json.loads(text)
        keys = (record[key] for key in ("session", "stream", "joint", "seq", "t_s"))
        self.database.execute(INSERT, (*keys, text))
        now_s = time.monotonic()
        self.latency_s.append(now_s - record["t_s"])
        self.ended = time.process_time(), now_s

    def told(self) -> dict[str, Any]:
        """Return the counters, with processor and wall time between the first and last record."""
        if self.began is None:
            raise RuntimeError("no record came")
        p50, p99 = np.percentile(np.asarray(self.latency_s), [50, 99])
        return {
            "stored": len(self.latency_s),
            "cpu_s": self.ended[0] - self.began[0],
            "wall_s": self.ended[1] - self.began[1],
            "p50_s": float(p50),
            "p99_s": float(p99),
        }


def open_records(path: str) -> sqlite3.Connection:
    """Open the table, creating it if it is missing; every statement is committed."""
    database = sqlite3.connect(path, isolation_level=None)
    database.execute("PRAGMA journal_mode = WAL")
    database.execute("PRAGMA synchronous = FULL")
    database.execute(
        "CREATE TABLE IF NOT EXISTS records (id INTEGER PRIMARY KEY, session INTEGER, stream TEXT,"
        " joint TEXT, seq INTEGER, t_s REAL, record TEXT)"
    )
    return database


async def run(plan: JsonServerPlan) -> dict[str, Any]:
    """Serve until a line on standard input requests the end."""
    recorder = Recorder(open_records(plan.database))
    async with serve(recorder.take, "127.0.0.1", plan.port, compression=None):
        print("ready", flush=True)
        await asyncio.to_thread(sys.stdin.readline)
    recorder.database.close()
    return recorder.told()


def main() -> None:
    """Read the plan from standard input and run it."""
    plan = JsonServerPlan(**json.loads(sys.stdin.readline()))
    with asyncio.Runner(loop_factory=uvloop.new_event_loop) as runner:
        print(json.dumps(runner.run(run(plan))), flush=True)


if __name__ == "__main__":
    main()
