"""The event log in SQL: append events with a hash chain, read them back, and verify the chain.

Each row's hash covers the previous hash and everything in the row, so the chain breaks at the first
row that was edited, removed or inserted.
"""

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import bindparam, insert, select
from sqlalchemy.orm import Session

from app.clock import Clock
from app.features.record.sessions.engine import Event, event_from_json, event_to_json
from app.models import SessionEvent

FIRST_HASH = "0" * 64
CONDITION_FIELDS = frozenset({"latency_ms", "body"})
"""Fields of events that reveal the session's condition."""
_OF_A_BODY = frozenset({"avatar_change_reported"})
"""Events whose content depends on the body that is worn: whether there is any reveals the body."""
_CONTENT_FIELDS = frozenset({"content_id", "content_hash"})
_APPENDED = insert(SessionEvent)
_HASH_AT = select(SessionEvent.hash).where(
    SessionEvent.session_id == bindparam("session_id"), SessionEvent.seq == bindparam("seq")
)


@dataclass(frozen=True)
class ChainCheck:
    """The result of verifying an event log; `broken_at` is the first seq that fails."""

    ok: bool
    events: int
    broken_at: int | None = None


def append_events(
    db: Session,
    *,
    session_id: str,
    version: int,
    events: Sequence[Event],
    actor: str,
    command_id: str | None,
    clock: Clock,
) -> None:
    """Append `events` after seq `version`.

    A second writer at the same seq violates the primary key, so a log can never fork.
    """
    previous = _last_hash(db, session_id, version)
    now, monotonic_ns = clock.utc_now(), clock.monotonic_ns()
    rows = []
    for offset, event in enumerate(events, start=1):
        row = {
            "session_id": session_id,
            "seq": version + offset,
            "type": event.type,
            "payload": canonical(event_to_json(event)),
            "actor": actor,
            "command_id": command_id,
            "recorded_at": now,
            "monotonic_ns": monotonic_ns,
            "previous_hash": previous,
        }
        previous = _hash(SessionEvent(**row))
        rows.append({**row, "hash": previous})
    db.connection().execute(_APPENDED, rows)


def events_of(db: Session, session_id: str) -> list[SessionEvent]:
    """Return the whole event log of a session, in order."""
    query = select(SessionEvent).where(SessionEvent.session_id == session_id)
    return list(db.scalars(query.order_by(SessionEvent.seq)))


def event_of(row: SessionEvent) -> Event:
    """Return the typed event of a row."""
    return event_from_json(row.type, json.loads(row.payload))


def verify_chain(rows: Sequence[SessionEvent], *, version: int | None = None) -> ChainCheck:
    """Verify a whole log: consecutive seqs, linked hashes, every hash recomputed.

    `version` is the session's own count of events; without it, a log whose end was removed cannot
    be distinguished from a shorter one.
    """
    previous = FIRST_HASH
    for expected_seq, row in enumerate(rows, start=1):
        intact = (
            row.seq == expected_seq and row.previous_hash == previous and row.hash == _hash(row)
        )
        if not intact:
            return ChainCheck(ok=False, events=len(rows), broken_at=expected_seq)
        previous = row.hash
    if version is not None and version != len(rows):
        return ChainCheck(ok=False, events=len(rows), broken_at=min(version, len(rows)) + 1)
    return ChainCheck(ok=True, events=len(rows))


def without_condition(kind: str, payload: Mapping[str, Any]) -> dict[str, Any]:
    """Return the payload of an event of this type without what reveals the session's condition.

    A headset reports the angles of the axes that a cast holds, and a body may lack the part. So a
    reader who must not know the body does not see either whether such a report has any content.
    """
    hidden = CONDITION_FIELDS | (_CONTENT_FIELDS if kind in _OF_A_BODY else frozenset())
    return {name: value for name, value in payload.items() if name not in hidden}


def canonical(value: object) -> str:
    """Serialise a value as canonical JSON: sorted keys, no spaces, no NaN."""
    return json.dumps(
        value, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False
    )


def _last_hash(db: Session, session_id: str, version: int) -> str:
    if version == 0:
        return FIRST_HASH
    last = db.scalar(_HASH_AT, {"session_id": session_id, "seq": version})
    if last is None:
        raise LookupError(f"session {session_id} has no event {version}")
    return last


def _hash(row: SessionEvent) -> str:
    covered = canonical(
        [
            row.session_id,
            row.seq,
            row.type,
            row.payload,
            row.actor,
            row.command_id,
            _utc_text(row.recorded_at),
            row.monotonic_ns,
        ]
    )
    return hashlib.sha256(f"{row.previous_hash}\n{covered}".encode()).hexdigest()


def _utc_text(moment: datetime) -> str:
    return moment.astimezone(UTC).isoformat(timespec="microseconds")
