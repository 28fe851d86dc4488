"""Simulate a headset's server without a network: phase orders by hand and a minimal server."""

from dataclasses import dataclass, field
from functools import partial
from typing import Any

from app.rehearsal.timed_run import FreeRun
from app.science.skeleton import JOINT_NAMES
from app.simulated_people.avatars import no_touches
from app.wire import StreamName, decode_batch
from app.wire.messages import (
    HeadsetState,
    ParticipantInfo,
    PhaseOrder,
    PhaseReport,
    ReportBody,
    Welcome,
)
from tests.rehearsal.ledger import digests

FRAME_S = 1 / 90


def order(**changes: Any) -> PhaseOrder:
    """Return an order for 1 s of free movement, with 0.5 s of preparation and 0.2 s of freeze."""
    usual = PhaseOrder(
        phase_id=1,
        kind="free_roam",
        limb=None,
        status="preparing",
        latency_ms=0.0,
        preparation_s=0.5,
        duration_s=1.0,
        freeze_s=0.2,
        active_s=0.0,
        completions=0,
        pausing=False,
        resuming=False,
    )
    return usual.model_copy(update=changes)


@dataclass
class Timeline:
    """A run drawn frame by frame at 90 Hz; `told` contains the reports in order."""

    run: FreeRun
    t_s: float = 0.0
    told: list[ReportBody] = field(default_factory=list)

    def draw(self, seconds: float, *, connected: bool = True) -> None:
        """Draw frames for a given time."""

        end_s = self.t_s + seconds
        while self.t_s + FRAME_S < end_s + 1e-9:
            self.t_s += FRAME_S
            self.told += self.run.frame(
                self.t_s, partial(no_touches, JOINT_NAMES), connected=connected
            )

    def follow(self, told: PhaseOrder) -> None:
        """Apply the server's newest order."""
        self.told += self.run.follow(told, self.t_s)

    @property
    def words(self) -> list[str]:
        """Return the names of the reports so far."""
        return [report.what for report in self.told if isinstance(report, PhaseReport)]


@dataclass
class InstantServer:
    """A substitute for a connected `TelemetryClient`: one phase, reports applied immediately."""

    phase: PhaseOrder
    epoch: int = 1
    connected: bool = True
    settled: bool = True
    status: str = "active"
    welcome: Welcome | None = None
    digests: list[str] = field(default_factory=list)
    reports: list[ReportBody] = field(default_factory=list)

    @property
    def state(self) -> HeadsetState:
        """Return the state as the server would send it."""
        return HeadsetState(
            version=len(self.reports),
            status=self.status,
            step_index=0,
            step_kind=self.phase.kind,
            materialised=True,
            recording=True,
            phase=self.phase,
            participant=ParticipantInfo(),
        )

    async def send_batch(self, stream: StreamName, _seq_end: int, message: bytes) -> None:
        """Store the digests of a batch's frames."""

        batch = decode_batch(message)
        told = digests(batch.times_s, batch.flags, batch.values, batch.header.phase_id)
        self.digests += [f"{stream} {digest}" for digest in told]

    async def report(self, body: ReportBody) -> None:
        """Apply a report to the phase."""
        self.reports.append(body)
        if not isinstance(body, PhaseReport):
            return
        became = {"started": "running", "walk_back_ended": "running", "time_up": "freezing"}
        status = became.get(body.what, body.what)
        self.phase = self.phase.model_copy(update={"status": status, "active_s": body.active_s})
        if body.what == "ended":
            self.status = "completed"

    async def at_most_waiting(self, _messages: int) -> None:
        """Return immediately, since no message ever waits."""

    async def drained(self) -> None:
        """Return immediately, since no message ever waits."""
