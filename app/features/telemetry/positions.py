"""How far each stream is stored. The writer is the only one who moves a position."""

from datetime import datetime

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.models import TelemetryStream
from app.wire.messages import REPORT_STREAM, StreamPosition


def position(
    db: Session, session_id: str, stream: str, epoch: int, now: datetime
) -> TelemetryStream:
    """The stream's row, made at its first message.

    The row is held for the whole transaction: SQLAlchemy forgets clean rows, and reading one again
    for every message costs a query and a flush each, most of the time that storing takes.
    """
    key = (session_id, stream, epoch)
    held: dict[tuple[str, str, int], TelemetryStream] = db.info.setdefault("stream_rows", {})
    row = held.get(key) or db.get(TelemetryStream, key)
    if row is None:
        row = TelemetryStream(
            session_id=session_id,
            stream=stream,
            epoch=epoch,
            next_seq=0,
            frames_stored=0,
            frames_flagged=0,
            phase_id=0,
            active_s=0.0,
            first_at=now,
            last_at=now,
        )
        db.add(row)
        db.flush()
    held[key] = row
    return row


def positions_of(db: Session, session_id: str) -> tuple[StreamPosition, ...]:
    """Every stream of a session, for a client that reconnects."""
    rows = db.scalars(
        select(TelemetryStream)
        .where(TelemetryStream.session_id == session_id)
        .order_by(TelemetryStream.epoch, TelemetryStream.stream)
    )
    return tuple(
        StreamPosition(stream=row.stream, epoch=row.epoch, next_seq=row.next_seq) for row in rows
    )


def take_epoch(db: Session, session_id: str, now: datetime) -> int:
    """The number of a new run of the client; never given out twice, even if nothing is sent.

    The session must be locked.
    """
    newest = db.scalar(
        select(func.max(TelemetryStream.epoch)).where(TelemetryStream.session_id == session_id)
    )
    epoch = (newest or 0) + 1
    position(db, session_id, REPORT_STREAM, epoch, now)
    return epoch


def certain_active_s(db: Session, session_id: str, phase_id: int) -> float:
    """The greatest active time of a phase that is on disk."""
    stored = db.scalar(
        select(func.max(TelemetryStream.active_s)).where(
            TelemetryStream.session_id == session_id, TelemetryStream.phase_id == phase_id
        )
    )
    return stored or 0.0
