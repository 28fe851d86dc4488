"""The browser's telemetry client on a page of its own, and the oracle of what it sent.

What the page makes is a function of stream, epoch and seq (`frontend/src/vr/telemetry/testing/
bench.ts`), so the test knows every bit of it without asking the page, which may be dead.
"""

import base64
import json
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from playwright.sync_api import BrowserContext, CDPSession, Page

from app.wire import StreamName
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
    """Movement with every odd float in it, so that a bit that changes on the way is seen."""
    rows = movement(seed=11)
    odd = every_odd_float()
    rows[100 : 100 + len(odd)] = odd
    return rows


@dataclass
class Headset:
    """A page with the client, in one browser context; `open` again is a new life of the page."""

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
        """Connect; the epoch of this run."""
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
        """Make batches of both streams and wait until all are taken."""
        self.page.evaluate("(args) => bench.produce(...args)", [batches, speed])

    def begin(self, batches: int, speed: float | None) -> None:
        """The same without waiting."""
        self.page.evaluate("(args) => bench.begin(...args)", [batches, speed])

    def drained(self) -> float:
        """Wait until everything is stored; seconds since the connection came up."""
        return float(self.page.evaluate("() => bench.drained()"))

    def flush(self) -> None:
        """Bring the journal to disk."""
        self.page.evaluate("() => bench.client.flush()")

    def wait_for(self, condition: str) -> None:
        """Until an expression of the page holds."""
        self.page.wait_for_function(f"() => {condition}", timeout=60_000)

    def tell(self, expression: str) -> Any:
        """What an expression of the page comes to."""
        return self.page.evaluate(f"() => {expression}")

    @property
    def status(self) -> dict[str, Any]:
        """How the sending goes."""
        status: dict[str, Any] = self.tell("bench.client.status")
        return status

    @property
    def made(self) -> "Made":
        """What was taken so far."""
        made = self.tell("bench.produced")
        return Made(int(made["frames"]), int(made["reports"]))

    def close(self) -> None:
        """Hang up."""
        self.page.evaluate("() => bench.client.close()")


Wear = Callable[..., Headset]
"""`wear(context=None, mode="worker", **limits)`: a fresh session's headset on a page."""


@dataclass(frozen=True)
class Meter:
    """Memory and time of a page's main thread, by Chromium's own account."""

    session: CDPSession

    @classmethod
    def of(cls, page: Page) -> "Meter":
        """Begin to measure."""
        session = page.context.new_cdp_session(page)
        session.send("Performance.enable")
        return cls(session)

    def heap_bytes(self) -> int:
        """Objects and buffers that are alive now."""
        self.session.send("HeapProfiler.collectGarbage")
        usage = self.session.send("Runtime.getHeapUsage")
        return int(usage["usedSize"] + usage.get("backingStorageSize", 0))

    def task_s(self) -> float:
        """Time that the main thread has worked."""
        metrics = self.session.send("Performance.getMetrics")["metrics"]
        return next(float(one["value"]) for one in metrics if one["name"] == "TaskDuration")


@dataclass(frozen=True)
class Made:
    """What a run has made: frames of each stream, and reports.

    `perhaps` more of each may have been made before the page died.
    """

    frames: int
    reports: int
    perhaps: int = 0


def sent_by(runs: dict[int, Made]) -> LedgerJournal:
    """What must be stored (as if acknowledged) and what may be, by epoch."""
    ledger, rows = LedgerJournal(), table()
    for epoch, made in runs.items():
        seqs = np.arange(made.frames + made.perhaps)
        for number, stream in enumerate(StreamName, start=1):
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
    """The database against what the runs have made; every frame bit by bit."""
    with record_of(server) as db:
        return reconcile(db, session_id, sent_by(runs))
