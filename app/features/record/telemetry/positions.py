"""Track how far each stream is stored. Only the writer changes a position."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from datetime import datetime
from itertools import count
from typing import Any, cast

from sqlalchemy import Table, select
from sqlalchemy.orm import Session

from app.features.record.doubts import exceeds_possible
from app.models import TelemetryStream
from app.rows import insert_rows
from app.wire import FINGER_STREAMS, MAX_EPOCH, REPORT_STREAM, Message, StreamPosition

Key = tuple[str, str, int]
"""Session id, stream and epoch."""
TABLE = cast("Table", TelemetryStream.__table__)
MOVING = ("next_seq", "produced", "frames_stored", "frames_flagged", "phase_id", "active_s")
_MOVED = (*MOVING, "last_at")


@dataclass
class Position:
    """The position up to which a stream is stored in the transaction; see `TelemetryStream`.

    `age_s`: how long the server has known the epoch.
    """

    key: Key
    next_seq: int = 0
    produced: int = 0
    frames_stored: int = 0
    frames_flagged: int = 0
    phase_id: int = 0
    active_s: float = 0.0
    is_changed: bool = False
    age_s: float = 0.0

    def claimed(self, made: int) -> None:
        """Record how many frames (or reports) the client says it has made.

        The highest claim is kept, since whatever has not arrived by the end is missing. But a count
        that no headset can have reached is not credible, so the next claim replaces it, whatever it
        is.
        """
        if made > self.produced or exceeds_possible(self.produced, self.age_s):
            self.produced, self.is_changed = made, True

    def stored(self, frames: int) -> None:
        """Advance the position by the frames (or reports) stored in this transaction."""
        self.next_seq += frames
        self.frames_stored += frames
        self.is_changed = True

    @property
    def as_message(self) -> StreamPosition:
        """Return the position in the form in which it is sent to the client."""
        _, stream, epoch = self.key
        return StreamPosition(stream=stream, epoch=epoch, next_seq=self.next_seq)


@dataclass
class Positions:
    """The positions that one transaction changes: read by one query, written by one more.

    A query and an update for every message would cost more than storing the message.
    """

    db: Session
    now: datetime
    _positions: dict[Key, Position] = field(default_factory=dict)
    _sessions: set[str] = field(default_factory=set)

    def fetch(self, session_ids: Iterable[str]) -> None:
        """Read all positions of these sessions."""
        missing = sorted(set(session_ids) - self._sessions)
        if not missing:
            return
        self._sessions.update(missing)
        for row in self.db.execute(select(TABLE).where(TABLE.c.session_id.in_(missing))).mappings():
            key = (row["session_id"], row["stream"], row["epoch"])
            values = {name: row[name] for name in MOVING}
            age_s = (self.now - row["first_at"]).total_seconds()
            self._positions[key] = Position(key, **values, age_s=age_s)

    def at(self, session_id: str, stream: str, epoch: int) -> Position:
        """Return a stream's position, which is 0 before its first message."""
        self.fetch([session_id])
        key = (session_id, str(stream), epoch)
        return self._positions.setdefault(key, Position(key))

    def flush(self) -> None:
        """Write the changed positions, so that queries of this transaction see them."""
        moved = [one for one in self._positions.values() if one.is_changed]
        if moved:
            insert_rows(self.db, TABLE, [self._row(one) for one in moved], moving=_MOVED)
        for one in moved:
            one.is_changed = False

    def _row(self, position: Position) -> dict[str, Any]:
        """Return the row of a position; if one exists, only its `MOVING` columns are updated."""
        session_id, stream, epoch = position.key
        key = {"session_id": session_id, "stream": stream, "epoch": epoch}
        moving = {name: getattr(position, name) for name in MOVING}
        return {**key, **moving, "first_at": self.now, "last_at": self.now}


def positions_of(db: Session, session_id: str) -> tuple[StreamPosition, ...]:
    """Return the positions of all streams of a session, for a client that reconnects."""
    rows = db.scalars(
        select(TelemetryStream)
        .where(TelemetryStream.session_id == session_id)
        .order_by(TelemetryStream.epoch, TelemetryStream.stream)
    )
    return tuple(
        StreamPosition(stream=row.stream, epoch=row.epoch, next_seq=row.next_seq) for row in rows
    )


def assign_epoch(
    db: Session, session_id: str, now: datetime, *, abilities: frozenset[str] = frozenset()
) -> int:
    """Assign the next epoch number; none is assigned twice, even if nothing is sent under it.

    `abilities`: what the client run says that it can do, which is stored. With `fingers` the
    epoch's streams of fingers exist from now on, even if nothing arrives in them.
    The session must be locked.
    """
    # A client may have used a number that the server never assigned, up to the maximum.
    taken = set(
        db.scalars(select(TelemetryStream.epoch).where(TelemetryStream.session_id == session_id))
    )
    epoch = max(taken, default=0) + 1
    if epoch > MAX_EPOCH:
        epoch = next(number for number in count(1) if number not in taken)
    announced: tuple[str, ...] = FINGER_STREAMS if "fingers" in abilities else ()
    db.add_all(
        TelemetryStream(
            session_id=session_id,
            stream=str(stream),
            epoch=epoch,
            phase_id=0,
            active_s=0.0,
            next_seq=0,
            frames_stored=0,
            frames_flagged=0,
            first_at=now,
            last_at=now,
            abilities=sorted(abilities) if stream == REPORT_STREAM else None,
        )
        for stream in (REPORT_STREAM, *announced)
    )
    db.flush()
    return epoch


def is_assigned_epoch(db: Session, session_id: str, epoch: int) -> bool:
    """Return whether the server assigned this epoch number in the session."""
    return db.get(TelemetryStream, (session_id, REPORT_STREAM, epoch)) is not None


def abilities_of(db: Session, session_id: str) -> dict[int, frozenset[str]]:
    """Return by epoch what its client run said that it can do; only epochs that stored it."""
    query = select(TelemetryStream.epoch, TelemetryStream.abilities).where(
        TelemetryStream.session_id == session_id, TelemetryStream.stream == REPORT_STREAM
    )
    return {
        epoch: frozenset(abilities)
        for epoch, abilities in db.execute(query)
        if abilities is not None
    }


@dataclass
class Outcome:
    """The result of a transaction for one sender, to be sent once the transaction is on disk.

    `messages`: how many of its messages were stored; `frames_flagged`: how many of their frames
    contain invalid values; `changed_state`: whether a report among them may have changed what the
    session's state tells a headset.
    """

    positions: dict[tuple[str, int], StreamPosition] = field(default_factory=dict)
    notices: list[Message] = field(default_factory=list)
    phases_ended: list[int] = field(default_factory=list)
    messages: int = 0
    frames_flagged: int = 0
    changed_state: bool = False

    def stored_up_to(self, position: Position) -> None:
        """Acknowledge a stream up to its current position."""
        _, stream, epoch = position.key
        self.positions[stream, epoch] = position.as_message
