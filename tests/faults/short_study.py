"""Store the shipped study with short phases on a server, so that faults take seconds.

It has two of the three latencies: the block in which faults happen, and a block after it.
"""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass

from app.rehearsal.cast import Cast
from app.wire.messages import PhaseOrder
from tests.features.record.sessions.engine_run import PLAN
from tests.protocol.helpers import edited
from tests.support.server import ADMIN_PASSWORD, LiveServer

KEY, PHASE_S, ROAM_S = "short-latency", 4.0, 2.0
AROUND_S = 0.5
TASKS = 4
LOOK_EVERY_S = 0.005
ONE_LATENCY_LESS = (
    """  - key: latency_0
    latency_ms: 0
    label: {en: no added latency, de: keine zusätzliche Verzögerung}
""",
    "",
)
FIRST_FOOT_STEP = next(step.index for step in PLAN if step.limb == "foot")


def short_study(
    *, phase_s: float = PHASE_S, roam_s: float = ROAM_S, around_s: float = AROUND_S
) -> str:
    """Return the study file, with preparation and freeze of each task lasting `around_s`."""
    return edited(
        ("key: reembodiment-latency", f"key: {KEY}"),
        ONE_LATENCY_LESS,
        ("duration_s: 120", f"duration_s: {roam_s}"),
        *[("duration_s: 60\n", f"duration_s: {phase_s}\n")] * 2,
        *[("freeze_s: 5", f"freeze_s: {around_s}")] * 2,
        *[("preparation_s: 5", f"preparation_s: {around_s}")] * 2,
    )


def add_short_study(server: LiveServer) -> str:
    """Store the short study and return its key."""
    text = short_study()
    with server.client() as client:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()
        client.post("/api/studies", json={"yaml": text}).raise_for_status()
    return KEY


@dataclass(frozen=True)
class Watch:
    """Wait until a rehearsal reaches a given state."""

    cast: Cast

    async def phase(self, phase_id: int, is_it: Callable[[PhaseOrder], bool]) -> None:
        """Wait until the headset is in this phase and `is_it` is true of the phase's state."""
        while True:
            state = self.cast.headset.client.state
            order = None if state is None else state.phase
            if order is not None and order.phase_id == phase_id and is_it(order):
                return
            await asyncio.sleep(LOOK_EVERY_S)

    async def paused(self, phase_id: int) -> None:
        """Wait until the phase's clock is paused."""
        await self.phase(phase_id, lambda order: order.status == "paused")

    async def running(self, phase_id: int) -> None:
        """Wait until the phase's clock runs."""
        await self.phase(phase_id, lambda order: order.status == "running")
