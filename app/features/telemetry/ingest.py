"""Storing one message inside the writer's transaction.

In every stream seqs are consecutive. What is stored already is acknowledged again, what overlaps is
cut to its new part, what skips ahead is asked for again: so resending is always safe and a hole can
never come about in silence.
"""

from dataclasses import dataclass, field
from datetime import datetime

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import ReembodyError
from app.features.context import AppContext
from app.features.sessions.engine.commands import HeadsetLost, Materialise, Report
from app.features.sessions.service import (
    apply_command,
    protocol_of_session,
    session_by_id,
    state_of,
)
from app.features.telemetry.positions import certain_active_s, position
from app.models import ClientReport, ClockProbe, Completion, Contact, Phase, TelemetryBatch
from app.models.telemetry import TelemetryStream
from app.wire import BatchHeader, FrameFlags, decode_batch, encode_batch
from app.wire.messages import (
    REPORT_STREAM,
    CompletionReport,
    ContactReport,
    Flag,
    MaterialisedReport,
    Message,
    PhaseReport,
    Probed,
    RefusedReport,
    Resend,
    StreamPosition,
)
from app.wire.messages import Report as ReportMessage


@dataclass
class Outcome:
    """What to tell the sender once the transaction is on disk; `messages` were stored for it."""

    positions: dict[tuple[str, int], StreamPosition] = field(default_factory=dict)
    notices: list[Message] = field(default_factory=list)
    phases_ended: list[int] = field(default_factory=list)
    messages: int = 0

    def stored_up_to(self, row: TelemetryStream) -> None:
        """Acknowledge a stream as far as its row says."""
        self.positions[(row.stream, row.epoch)] = StreamPosition(
            stream=row.stream, epoch=row.epoch, next_seq=row.next_seq
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


def store_report(
    db: Session,
    context: AppContext,
    session_id: str,
    message: ReportMessage,
    now: datetime,
    outcome: Outcome,
) -> None:
    """Store a report and act on it; one that does not fit is kept with the reason."""
    row = position(db, session_id, REPORT_STREAM, message.epoch, now)
    if message.seq > row.next_seq:
        outcome.notices.append(Resend(stream=row.stream, epoch=row.epoch, next_seq=row.next_seq))
        return
    if message.seq < row.next_seq:
        outcome.stored_up_to(row)
        return
    refusal = _act(db, context, session_id, message, outcome)
    db.add(
        ClientReport(
            session_id=session_id,
            epoch=message.epoch,
            seq=message.seq,
            type=message.body.kind,
            payload=message.body.model_dump(),
            accepted=refusal is None,
            refusal=None if refusal is None else refusal.message[:400],
            received_at=now,
        )
    )
    row.next_seq, row.last_at = message.seq + 1, now
    row.frames_stored += 1
    outcome.stored_up_to(row)
    if refusal is not None:
        outcome.notices.append(
            RefusedReport(
                epoch=message.epoch,
                seq=message.seq,
                message=refusal.message,
                remedy=refusal.remedy,
            )
        )


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


def _act(
    db: Session,
    context: AppContext,
    session_id: str,
    message: ReportMessage,
    outcome: Outcome,
) -> ReembodyError | None:
    """Do what a report says; the refusal if it does not fit."""
    body = message.body
    try:
        with db.begin_nested():
            match body:
                case PhaseReport():
                    _act_on_phase(db, context, session_id, body, outcome)
                case MaterialisedReport():
                    session = session_by_id(db, session_id, lock=True)
                    command = Materialise(by="headset", client_t_s=body.t_s)
                    apply_command(db, context, session, command, actor="headset")
                case ContactReport():
                    _require_phase(db, session_id, body.phase_id)
                    values = body.model_dump(exclude={"kind"})
                    db.add(Contact(session_id=session_id, **values))
                case CompletionReport():
                    _require_phase(db, session_id, body.phase_id)
                    _require_new(db, session_id, body)
                    db.add(_completion(session_id, body))
    except ReembodyError as refusal:
        return refusal
    return None


def _act_on_phase(
    db: Session, context: AppContext, session_id: str, body: PhaseReport, outcome: Outcome
) -> None:
    session = session_by_id(db, session_id, lock=True)
    command = Report(
        what=body.what,
        phase_id=body.phase_id,
        client_t_s=body.t_s,
        active_s=body.active_s,
        cause=body.cause,
    )
    apply_command(db, context, session, command, actor="headset")
    if body.what == "ended":
        outcome.phases_ended.append(body.phase_id)


def _completion(session_id: str, body: CompletionReport) -> Completion:
    return Completion(
        session_id=session_id,
        phase_id=body.phase_id,
        number=body.number,
        at_s=body.t_s,
        active_s=body.active_s,
        duration_s=body.duration_s,
        order=list(body.order),
        out_of_order_touches=body.out_of_order_touches,
    )


def _require_phase(db: Session, session_id: str, phase_id: int) -> None:
    known = db.scalar(
        select(Phase.phase_id).where(Phase.session_id == session_id, Phase.phase_id == phase_id)
    )
    if known is None:
        raise ReembodyError(
            f"there is no phase {phase_id}",
            value=phase_id,
            remedy="Use the phase_id of the newest state message.",
        )


def _require_new(db: Session, session_id: str, body: CompletionReport) -> None:
    if db.get(Completion, (session_id, body.phase_id, body.number)) is not None:
        raise ReembodyError(
            f"completion {body.number} of phase {body.phase_id} was reported before",
            value=body.number,
            remedy="Count on from the completions in the newest state message.",
        )


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
