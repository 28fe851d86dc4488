"""Stream one headset in a running phase: 90 frames a second of both streams, six per message."""

import asyncio
import time
from array import array
from dataclasses import dataclass, field

import numpy as np

from app.wire import BODY_STREAMS, StreamName, encode_batch
from app.wire.batch import ACTIVE
from app.wire.messages import ContactReport, PhaseReport
from tests.benchmarks.load.headset import Headset
from tests.benchmarks.load.movement import LOOP_FRAMES, RATE_HZ, Movement
from tests.benchmarks.load.record import Digest, Record

FRAMES_PER_BATCH = 6
FIRST_T_S = 1.0
"""The headset's clock at its first frame."""
STARTS_WITHIN_S = 30.0


@dataclass
class Streaming:
    """A headset that streams `movement` from frame `offset` on; `lag_s`: each message's delay (s).

    `active_from_s`: the elapsed active time of the phase, in a run that continues one.
    """

    headset: Headset
    record: Record
    movement: Movement
    offset: int
    contact_every_s: float | None
    digested: bool
    active_from_s: float = 0.0
    lag_s: "array[float]" = field(default_factory=lambda: array("d"))
    phase_id: int = 0

    async def enter_phase(self) -> None:
        """Wait until the operator begins the phase, then start its clock."""
        give_up_s = time.monotonic() + STARTS_WITHIN_S
        while True:
            state = self.headset.state
            if state is not None and state.phase is not None:
                break
            if time.monotonic() > give_up_s:
                raise TimeoutError(f"no phase was called for {self.record.session_id}")
            await asyncio.sleep(0.05)
        self.phase_id = state.phase.phase_id
        await self.headset.report(
            PhaseReport(phase_id=self.phase_id, what="started", t_s=FIRST_T_S, active_s=0.0)
        )

    async def run(self, begin_s: float, end_s: float) -> None:
        """Stream in real time between two readings of this machine's monotonic clock."""
        if self.digested:
            self.record.digests.update((name.value, Digest()) for name in BODY_STREAMS)
        seq, contact_s = 0, self.contact_every_s or 0.0
        while True:
            due_s = begin_s + (seq + FRAMES_PER_BATCH) / RATE_HZ
            if due_s > end_s:
                return
            await asyncio.sleep(max(0.0, due_s - time.monotonic()))
            self.lag_s.append(time.monotonic() - due_s)
            await self.send(seq)
            seq += FRAMES_PER_BATCH
            if self.contact_every_s is not None and seq / RATE_HZ > contact_s:
                contact_s += self.contact_every_s
                await self.touch(seq / RATE_HZ)

    async def send(self, seq: int) -> None:
        """Send the messages of both streams that begin at `seq`."""
        at = (self.offset + seq) % LOOP_FRAMES
        here = slice(at, at + FRAMES_PER_BATCH)
        times_s = FIRST_T_S + (seq + np.arange(FRAMES_PER_BATCH)) / RATE_HZ
        times_s += self.movement.jitter_s.take(range(at, at + FRAMES_PER_BATCH), mode="wrap")
        flags = np.full(FRAMES_PER_BATCH, ACTIVE, np.uint8)
        for name, loop in (
            (StreamName.TARGET, self.movement.target),
            (StreamName.ACTUAL, self.movement.actual),
        ):
            message = encode_batch(
                name,
                epoch=self.headset.epoch,
                phase_id=self.phase_id,
                seq_first=seq,
                times_s=times_s,
                flags=flags,
                values=loop[here],
                active_s=self.active_from_s + seq / RATE_HZ,
                closed_at_s=float(times_s[-1]),
            )
            await self.headset.hand(name, seq + FRAMES_PER_BATCH, message)
            if self.digested:
                self.record.digests[name.value].take(times_s, flags, loop[here])

    async def touch(self, active_s: float) -> None:
        """Report a contact of a hand with one side of a box."""
        await self.headset.report(
            ContactReport(
                phase_id=self.phase_id,
                surface="hand/2/left",
                surface_kind="side",
                box=2,
                side="left",
                body_part="right_hand",
                begin_s=FIRST_T_S + active_s - 0.2,
                end_s=FIRST_T_S + active_s,
                begin_active_s=active_s - 0.2,
                end_active_s=active_s,
                effect="side",
            )
        )


def batch_of(client_t_s: float) -> int:
    """Return the index of the message whose newest frame has this time of the headset's clock."""
    newest = (client_t_s - FIRST_T_S) * RATE_HZ
    return round((newest - (FRAMES_PER_BATCH - 1)) / FRAMES_PER_BATCH)
