"""Store messages within the writer's transaction.

In every stream, seqs are consecutive. What is already stored is acknowledged once more, what
overlaps is cut to its new part, and what skips ahead is requested again. So resending is always
safe, and a gap can never arise unnoticed.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any, cast

from sqlalchemy import Table, select
from sqlalchemy.orm import Session

from app.features.record.alarms import Change, Condition, store_change
from app.features.record.doubts import OBSERVED
from app.features.record.sessions import (
    HeadsetLost,
    apply_command,
    certain_active_s,
    protocol_of_session,
    state_of,
)
from app.features.record.telemetry.positions import Outcome, Positions
from app.models import ClockProbe, Phase, TelemetryBatch, new_id
from app.platform.access import session_by_id
from app.platform.context import AppContext
from app.rows import insert_rows
from app.wire import (
    BatchHeader,
    Flag,
    FrameFlags,
    Probed,
    Produced,
    Resend,
    decode_batch,
    encode_batch,
)

BATCHES = cast("Table", TelemetryBatch.__table__)
PROBES = cast("Table", ClockProbe.__table__)


@dataclass
class Intake:
    """The rows that one transaction stores, collected for one write by `flush`.

    Call `flush` before reading the tables within the transaction.
    """

    db: Session
    context: AppContext
    now: datetime
    positions: Positions = field(init=False)
    _rows: dict[Table, list[dict[str, Any]]] = field(default_factory=dict)
    _phases: dict[str, set[int]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.positions = Positions(self.db, self.now)

    def flush(self) -> None:
        """Write the rows collected so far."""
        self.positions.flush()
        for table, rows in self._rows.items():
            insert_rows(self.db, table, rows)
        self._rows.clear()

    def gather(self, table: Table, row: dict[str, Any]) -> None:
        """Collect a row, to be inserted together with the others of its table."""
        self._rows.setdefault(table, []).append(row)

    def gathers(self, table: Table, **key: object) -> bool:
        """Return whether a row with these values was collected for a table already."""
        rows = self._rows.get(table, [])
        return any(key.items() <= row.items() for row in rows)

    def fetch_phases(self, session_ids: Iterable[str]) -> None:
        """Read the phases of these sessions once per transaction, as none is prepared in it."""
        missing = sorted(set(session_ids) - self._phases.keys())
        if not missing:
            return
        self._phases.update({session_id: set() for session_id in missing})
        query = select(Phase.session_id, Phase.phase_id).where(Phase.session_id.in_(missing))
        for session_id, phase_id in self.db.execute(query):
            self._phases[session_id].add(phase_id)

    def has_phase(self, session_id: str, phase_id: int) -> bool:
        """Return whether the session has this phase."""
        self.fetch_phases([session_id])
        return phase_id in self._phases[session_id]

    def store_batch(
        self,
        session_id: str,
        header: BatchHeader,
        message: bytes,
        flags: FrameFlags,
        outcome: Outcome,
    ) -> None:
        """Store the new part of a batch as received, and count its flagged frames."""
        at = self.positions.at(session_id, header.stream, header.epoch)
        if header.seq_first > at.next_seq:
            # The client has also made what comes before this batch, so that is missing until it
            # arrives.
            at.claimed(header.seq_end)
            outcome.notices.append(Resend(**at.as_message.model_dump()))
            return
        skip = at.next_seq - header.seq_first
        if skip < header.frame_count:
            self.gather(
                BATCHES,
                {
                    "session_id": session_id,
                    "stream": str(header.stream),
                    "epoch": header.epoch,
                    "seq_first": at.next_seq,
                    "frame_count": header.frame_count - skip,
                    "phase_id": header.phase_id,
                    "received_at": self.now,
                    "message": message if skip == 0 else _without_first(message, skip),
                },
            )
            bad = int(flags.bad[skip:].sum())
            at.stored(header.frame_count - skip)
            at.frames_flagged += bad
            if header.phase_id not in (0, at.phase_id):
                self._require_phase(session_id, header.phase_id)
            at.phase_id, at.active_s = header.phase_id, header.active_s
            if bad:
                outcome.frames_flagged += bad
                outcome.notices.append(_flag(header, flags, skip))
        outcome.stored_up_to(at)

    def _require_phase(self, session_id: str, phase_id: int) -> None:
        """Put the session in doubt if it has no such phase; the frames are stored as received."""
        if not self.has_phase(session_id, phase_id):
            words = f"frames arrived of phase {phase_id}, which this session does not have"
            self.store_alarm(session_id, Change("raised", Condition(OBSERVED, words), self.now))

    def store_probe(self, session_id: str, epoch: int, probe: Probed) -> None:
        """Store a raw clock probe."""
        times = probe.model_dump(exclude={"type"})
        self.gather(
            PROBES,
            {
                "id": new_id(),
                "session_id": session_id,
                "epoch": epoch,
                "server_utc": self.now,
                **times,
            },
        )

    def store_produced(self, session_id: str, produced: Produced) -> None:
        """Record how many frames and reports the client says it has produced."""
        for stream, count in produced.streams.items():
            self.positions.at(session_id, stream, produced.epoch).claimed(count)

    def store_loss(self, session_id: str, cause: str) -> None:
        """Record the loss of the headset: pause a running phase at the last active time on disk.

        If the study says `on_disconnect: continue`, the headset continues, using its journal.
        """
        self.flush()
        session = session_by_id(self.db, session_id, lock=True)
        state = state_of(session)
        if state.status != "active" or state.phase is None:
            return
        if protocol_of_session(self.db, session).on_disconnect == "continue":
            return
        active_s = certain_active_s(self.db, session_id, state.phase.phase_id)
        lost = HeadsetLost(active_s=active_s, cause=cause)
        apply_command(self.db, self.context, session, lost, actor="system")

    def store_alarm(self, session_id: str, change: Change) -> None:
        """Record the raising or clearing of an alarm, and make pages refresh.

        No alarm is raised for a session that has ended, since its end has cleared them all, except
        for an impossible report, which is always recorded.
        """
        raised = change.state == "raised" and change.condition.code != OBSERVED
        if raised and session_by_id(self.db, session_id, lock=True).ended_at is not None:
            return
        if store_change(self.db, session_id, change):
            self.context.hub.publish_after_commit(self.db, session_id)


def _without_first(message: bytes, count: int) -> bytes:
    batch = decode_batch(message)
    header = batch.header
    return encode_batch(
        header.stream,
        epoch=header.epoch,
        phase_id=header.phase_id,
        seq_first=header.seq_first + count,
        times_s=batch.times_s[count:],
        flags=batch.flags[count:],
        values=batch.values[count:],
        active_s=header.active_s,
        closed_at_s=header.closed_at_s,
    )


def _flag(header: BatchHeader, flags: FrameFlags, skip: int) -> Flag:
    bad = flags.bad[skip:]
    first = int(bad.argmax()) + skip
    broken = bool(flags.non_finite[skip:].any())
    what = (
        "a value that is not a number, or hips that are in no room"
        if broken
        else "a rotation that is not of unit length"
    )
    return Flag(
        code="non_finite" if broken else "non_unit",
        stream=header.stream,
        epoch=header.epoch,
        seq=header.seq_first + first,
        frames=int(bad.sum()),
        message=f"{int(bad.sum())} frame(s) hold {what}; stored, left out of summaries",
    )
