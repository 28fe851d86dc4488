"""Kill the server during a rehearsal and read the stored record before and after the restart."""

import asyncio
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from app.rehearsal.cast import Cast
from tests.faults.record import OnDisk, read_record, record_of
from tests.faults.schedule import Target, seen
from tests.rehearsal.ledger import LedgerJournal
from tests.support.server import LiveServer

LOOK_EVERY_S = 0.002
RECOVERS_WITHIN_S = 60.0


@dataclass(frozen=True)
class Kill:
    """One kill of the server, and the stored record before and after the restart.

    `lost`: acknowledged frames and reports that are not on disk. `surplus`: the number of rows that
    differ from the stored positions. `acked_active_s` and `used_active_s`: active time of the
    current phase that the server had acknowledged, and that the headset had used. `recovery_s`:
    time in s from the kill until the headset was connected again.
    """

    target: Target
    before: OnDisk
    after: OnDisk
    acked: int
    stored: int
    lost: int
    surplus: int
    acked_active_s: float
    used_active_s: float
    recovery_s: float


@dataclass
class Killer:
    """Kill the server at scheduled targets during a rehearsal; skip targets already passed."""

    server: LiveServer
    cast: Cast
    ledger: LedgerJournal
    kills: list[Kill] = field(default_factory=list)

    async def run(self, targets: Iterable[Target], most: int) -> None:
        """Kill the server up to `most` times."""
        for target in targets:
            if len(self.kills) == most:
                return
            if await self._met(target):
                await asyncio.sleep(target.wait_s)
                self.kills.append(await self._kill(target))

    async def _met(self, target: Target) -> bool:
        """Wait until the session reaches the target; return False if it has already passed it."""
        while True:
            step, kind = seen(self.cast.headset.client.state)
            if (step > target.step and kind != "setup") or self._is_over():
                return False
            if kind == target.kind and (step == target.step or kind == "setup"):
                return True
            await asyncio.sleep(LOOK_EVERY_S)

    def _is_over(self) -> bool:
        state = self.cast.headset.client.state
        return state is not None and state.status == "completed"

    async def _kill(self, target: Target) -> Kill:
        reconnects = self.cast.headset.client.reconnects
        began_s = time.monotonic()
        await asyncio.to_thread(self.server.kill)
        # Messages that the killed server had sent may still be in a buffer; then none are
        # acknowledged.
        await asyncio.sleep(0.01)
        acked = dict(self.ledger.acked)
        before = await asyncio.to_thread(self._on_disk)
        phase_id = before.phase_id or 0
        acked_active_s = self.ledger.acknowledged_active_s(phase_id)
        await asyncio.to_thread(self.server.start)
        after = await asyncio.to_thread(self._on_disk)
        used_active_s = self.ledger.used_active_s(phase_id)
        await asyncio.wait_for(self._reconnected(reconnects), RECOVERS_WITHIN_S)
        return Kill(
            target,
            before,
            after,
            acked=sum(acked.values()),
            stored=sum(before.stored.values()),
            lost=sum(max(0, seq - before.stored.get(key, 0)) for key, seq in acked.items()),
            surplus=sum(abs(before.held[key] - seq) for key, seq in before.stored.items()),
            acked_active_s=acked_active_s,
            used_active_s=used_active_s,
            recovery_s=time.monotonic() - began_s,
        )

    def _on_disk(self) -> OnDisk:
        with record_of(self.server) as db:
            return read_record(db, self.cast.operator.session_id)

    async def _reconnected(self, reconnects: int) -> None:
        client = self.cast.headset.client
        while client.reconnects == reconnects or not client.connected:  # noqa: ASYNC110 - a test's look
            await asyncio.sleep(LOOK_EVERY_S)


def figures(kills: Sequence[Kill]) -> str:
    """Format the kills as a table by kind of step, with the recovery times."""
    times_s = sorted(kill.recovery_s for kill in kills)
    lines = ["", f"{'killed in':<14}{'kills':>6}{'acked':>10}{'stored':>10}{'lost':>6}{'twice':>6}"]
    for kind in sorted({kill.before.kind for kill in kills}):
        those = [kill for kill in kills if kill.before.kind == kind]
        lines.append(_line(kind, those))
    lines.append(_line("all", kills))
    half, most = (
        times_s[len(times_s) // 2],
        times_s[min(len(times_s) - 1, len(times_s) * 95 // 100)],
    )
    return "\n".join([*lines, f"recovery p50 {half:.2f} s, p95 {most:.2f} s", ""])


def _line(name: str, kills: Sequence[Kill]) -> str:
    counts = [
        sum(getattr(kill, what) for kill in kills)
        for what in ("acked", "stored", "lost", "surplus")
    ]
    acked, stored, lost, surplus = counts
    return f"{name:<14}{len(kills):>6}{acked:>10}{stored:>10}{lost:>6}{surplus:>6}"
