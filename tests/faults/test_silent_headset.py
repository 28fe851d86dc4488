"""Tests that a session continues after a connected headset stops sending frames for a while."""

import asyncio
from collections.abc import Coroutine
from pathlib import Path
from typing import Any

from sqlalchemy import select

from app.models import AlarmRow
from app.rehearsal.cast import Cast
from app.rehearsal.headset import Headset
from tests.faults.record import record_of
from tests.faults.relay import Relay
from tests.faults.short_study import Watch
from tests.faults.test_connections import FOOT, HAND, rehearse_with, sound, worn_while
from tests.rehearsal.ledger import LedgerJournal
from tests.support.server import LiveServer

SILENT_S = 0.15
"""Ten times as long for a client that runs faster than real time."""
NOTICED_WITHIN_S = 60.0
"""A server with little processor time allows for its own delays, and waits."""


def test_a_silent_headset_is_paused_and_gets_its_whole_time(
    tmp_path: Path,
) -> None:
    """A headset without frames is paused in hand and foot phases, without loss of time or data.

    Headset and server count the same active time.
    """
    ledger = LedgerJournal()

    async def fall_asleep(cast: Cast, _: Relay) -> None:
        for phase_id in (HAND, FOOT):
            await Watch(cast).running(phase_id)
            await asyncio.sleep(0.2)
            await _hold_frames(cast.headset, Watch(cast).paused(phase_id))

    environment = {"REEMBODY_HEADSET_SILENT_S": str(SILENT_S)}
    with LiveServer(tmp_path / "live", environment=environment) as server:
        outcome = rehearse_with(server, worn_while(fall_asleep), ledger)
        assert sound(server, outcome, ledger)
        with record_of(server) as db:
            rows = db.scalars(select(AlarmRow).where(AlarmRow.code == "silent"))
            states = [row.state for row in rows]
    for phase_id in (HAND, FOOT):
        causes = {pause["cause"] for pause in outcome.pauses(phase_id)}
        assert "headset_silent" in causes
    assert states.count("raised") == states.count("cleared") >= 1


async def _hold_frames(headset: Headset, noticed: Coroutine[Any, Any, None]) -> None:
    """Send no frames until the server has noticed; other messages continue."""
    awake = asyncio.Event()
    due = headset._sleep_until_due

    async def sleep() -> None:
        await awake.wait()

    # The simulated headset has no switch for this, and needs none outside this test.
    headset._sleep_until_due = sleep  # type: ignore[method-assign]  # it sleeps on purpose
    async with asyncio.timeout(NOTICED_WITHIN_S):
        await noticed
    headset._sleep_until_due = due  # type: ignore[method-assign]  # it sleeps on purpose
    awake.set()
