"""Storing one message inside the writer's transaction.

In every stream seqs are consecutive. What is stored already is acknowledged again, what overlaps is
cut to its new part, what skips ahead is asked for again: so resending is always safe and a hole can
never come about in silence.
"""

from datetime import datetime

from sqlalchemy.orm import Session

from app.features.context import AppContext
from app.features.sessions.engine.commands import HeadsetLost
from app.features.sessions.service import (
    apply_command,
    protocol_of_session,
    session_by_id,
    state_of,
)
from app.features.telemetry.outcome import Outcome
from app.features.telemetry.positions import certain_active_s, position
from app.models import ClockProbe, TelemetryBatch
from app.wire import BatchHeader, FrameFlags, decode_batch, encode_batch
from app.wire.messages import (
    Flag,
    Probed,
    Resend,
)


def store_batch(
    db: Session,
    session_id: str,
    header: BatchHeader,
    message: bytes,
    flags: FrameFlags,
    now: datetime,
    outcome: Outcome,
) -> None:
    """Store a batch as it came, with its flags counted beside it."""
    row = position(db, session_id, header.stream, header.epoch, now)
    if header.seq_first > row.next_seq:
        outcome.notices.append(Resend(stream=row.stream, epoch=row.epoch, next_seq=row.next_seq))
        return
    if header.seq_end <= row.next_seq:
        outcome.stored_up_to(row)
        return
    skip = row.next_seq - header.seq_first
    db.add(
        TelemetryBatch(
            session_id=session_id,
            stream=header.stream,
            epoch=header.epoch,
            seq_first=row.next_seq,
            frame_count=header.frame_count - skip,
            phase_id=header.phase_id,
            received_at=now,
            message=message if skip == 0 else _without_first(message, skip),
        )
    )
    bad = int(flags.bad[skip:].sum())
    row.next_seq = header.seq_end
    row.frames_stored += header.frame_count - skip
    row.frames_flagged += bad
    row.phase_id, row.active_s, row.last_at = header.phase_id, header.active_s, now
    outcome.stored_up_to(row)
    if bad:
        outcome.notices.append(_flag(header, flags, skip))


def store_probe(db: Session, session_id: str, epoch: int, probe: Probed, now: datetime) -> None:
    """Keep one raw reading of the clocks."""
    db.add(
        ClockProbe(
            session_id=session_id,
            epoch=epoch,
            client_sent_s=probe.client_sent_s,
            server_received_ns=probe.server_received_ns,
            server_sent_ns=probe.server_sent_ns,
            client_received_s=probe.client_received_s,
            server_utc=now,
        )
    )


def store_loss(db: Session, context: AppContext, session_id: str, cause: str) -> None:
    """The headset is gone: a running clock stops at the last active time that is on disk.

    Where the study says `on_disconnect: continue`, the headset goes on by its journal.
    """
    session = session_by_id(db, session_id, lock=True)
    state = state_of(session)
    if state.status != "active" or state.phase is None:
        return
    if protocol_of_session(db, session).on_disconnect == "continue":
        return
    active_s = certain_active_s(db, session_id, state.phase.phase_id)
    apply_command(db, context, session, HeadsetLost(active_s=active_s, cause=cause), actor="system")


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
    what = "a value that is not a number" if broken else "a rotation that is not of unit length"
    return Flag(
        code="non_finite" if broken else "non_unit",
        stream=header.stream,
        epoch=header.epoch,
        seq=header.seq_first + first,
        frames=int(bad.sum()),
        message=f"{int(bad.sum())} frame(s) hold {what}; stored, left out of summaries",
    )
