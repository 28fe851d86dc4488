"""Run the browser's telemetry client on a test page, and verify the data that it sent.

The page's data are a function of stream, epoch and seq
(`frontend/src/vr/telemetry/testing/bench.ts`), so the test knows every bit of them without asking
the page, which may have crashed.
"""

import base64
import json
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from playwright.sync_api import BrowserContext, CDPSession, Page

from app.wire import BODY_STREAMS
from app.wire.messages import REPORT_STREAM
from tests.benchmarks.headsets import movement
from tests.faults.record import record_of
from tests.rehearsal.ledger import LedgerJournal, Reconciliation, digests, reconcile
from tests.support.bundle import Bundle
from tests.support.server import LiveServer
from tests.wire.samples import every_odd_float

RATE_HZ = 90
FRAMES_PER_BATCH = 6
FRAMES_PER_REPORT = 90
BATCHES_PER_S = RATE_HZ // FRAMES_PER_BATCH
MEBIBYTE = 2**20
Mode = Literal["page", "worker"]


def table() -> NDArray[np.float32]:
    """Return movement that contains every unusual float, so that any changed bit is noticed."""
    rows = movement(seed=11)
    odd = every_odd_float()
    rows[100 : 100 + len(odd)] = odd
    return rows


@dataclass
class Headset:
    """A page with the telemetry client; calling `open` again restarts the client."""

    context: BrowserContext
    bundle: Bundle
    server: LiveServer
    session_id: str
    token: str
    mode: Mode = "worker"
    limits: dict[str, float] = field(default_factory=dict)
    page: Page = field(init=False)

    def load(self) -> "Headset":
        """Open the page, which does not connect yet."""
        self.page = self.bundle.open(self.context, self.server.url)
        return self

    def open(self) -> int:
        """Connect and return the epoch of this run."""
        options = {
            "url": f"{self.server.url.replace('http', 'ws', 1)}/api/vr/stream",
            "token": self.token,
            "name": "browser test",
            "storageKey": self.session_id,
            "limits": self.limits,
        }
        rows = base64.b64encode(table().tobytes()).decode()
        arguments = [options, self.mode == "worker", rows]
        return int(self.page.evaluate("(args) => bench.open(...args)", arguments))

    def produce(self, batches: int, speed: float | None) -> None:
        """Produce batches of both streams and wait until all are accepted."""
        self.page.evaluate("(args) => bench.produce(...args)", [batches, speed])

    def begin(self, batches: int, speed: float | None) -> None:
        """Start producing batches of both streams without waiting."""
        self.page.evaluate("(args) => bench.begin(...args)", [batches, speed])

    def drained(self) -> float:
        """Wait until everything is stored; return the seconds since the connection was opened."""
        return float(self.page.evaluate("() => bench.drained()"))

    def flush(self) -> None:
        """Write the journal to disk."""
        self.page.evaluate("() => bench.client.flush()")

    def wait_for(self, condition: str) -> None:
        """Wait until a JavaScript expression in the page is true."""
        self.page.wait_for_function(f"() => {condition}", timeout=60_000)

    def tell(self, expression: str) -> Any:
        """Return the value of a JavaScript expression in the page."""
        return self.page.evaluate(f"() => {expression}")

    @property
    def status(self) -> dict[str, Any]:
        """Return the client's sending status."""
        status: dict[str, Any] = self.tell("bench.client.status")
        return status

    @property
    def made(self) -> "Made":
        """Return the numbers of frames and reports accepted so far."""
        made = self.tell("bench.produced")
        return Made(int(made["frames"]), int(made["reports"]))

    def close(self) -> None:
        """Close the connection."""
        self.page.evaluate("() => bench.client.close()")


Wear = Callable[..., Headset]
"""`wear(context=None, mode="worker", **limits)`: a fresh session's headset on a page."""


@dataclass(frozen=True)
class Meter:
    """The memory and processor time of a page's main thread, as Chromium reports them."""

    session: CDPSession

    @classmethod
    def of(cls, page: Page) -> "Meter":
        """Start measuring a page."""
        session = page.context.new_cdp_session(page)
        session.send("Performance.enable")
        return cls(session)

    def heap_bytes(self) -> int:
        """Return the size of all live objects and buffers."""
        self.session.send("HeapProfiler.collectGarbage")
        usage = self.session.send("Runtime.getHeapUsage")
        return int(usage["usedSize"] + usage.get("backingStorageSize", 0))

    def task_s(self) -> float:
        """Return the processor time of the main thread."""
        metrics = self.session.send("Performance.getMetrics")["metrics"]
        return next(float(one["value"]) for one in metrics if one["name"] == "TaskDuration")


@dataclass(frozen=True)
class Made:
    """The numbers of frames per stream and of reports that a run produced.

    `perhaps` more of each may have been produced before the page crashed.
    """

    frames: int
    reports: int
    perhaps: int = 0


def sent_by(runs: dict[int, Made]) -> LedgerJournal:
    """Return, by epoch, the data that must be stored (as if acknowledged) and those that may be."""
    ledger, rows = LedgerJournal(), table()
    for epoch, made in runs.items():
        seqs = np.arange(made.frames + made.perhaps)
        for number, stream in enumerate(BODY_STREAMS, start=1):
            values = rows[seqs % len(rows)]
            values[:, 0], values[:, 1], values[:, 2] = epoch, number, seqs
            flags = (seqs % 2).astype(np.uint8)
            ledger.sent[stream, epoch] = digests(seqs / RATE_HZ, flags, values, 0)
            ledger.acked[stream, epoch] = made.frames
        told = [
            {"kind": "materialised", "t_s": float(seq)}
            for seq in range(made.reports + made.perhaps)
        ]
        ledger.sent[REPORT_STREAM, epoch] = [json.dumps(body, sort_keys=True) for body in told]
        ledger.acked[REPORT_STREAM, epoch] = made.reports
    return ledger


def reconciled(server: LiveServer, session_id: str, runs: dict[int, Made]) -> Reconciliation:
    """Compare the database bit by bit with what the runs produced."""
    with record_of(server) as db:
        return reconcile(db, session_id, sent_by(runs))
