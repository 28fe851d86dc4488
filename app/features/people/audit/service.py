"""The audit trail: who did what to which object, appended and hash-chained, never switched off.

A session has a log of its own; this one holds what happens around sessions: logins, accounts,
studies, copies of data, erasures. It holds nothing of participants, not even their codes: what is
chained cannot be erased.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from app.models import AuditEntry, AuditHead
from app.protocol import canonical_json, sha256_of

FIRST_HASH = "0" * 64
_HEAD = 1


@dataclass(frozen=True)
class AuditCheck:
    """Whether the trail verifies; `broken_at` is the first seq that does not."""

    ok: bool
    entries: int
    broken_at: int | None = None


def record(
    db: Session,
    *,
    actor: str,
    action: str,
    subject: str = "",
    details: Mapping[str, Any] | None = None,
    now: datetime,
) -> AuditEntry:
    """Append one act to the trail, in the caller's transaction: both happen or neither.

    Writers queue on the head of the chain until their transaction ends. Call it last, so that no
    two transactions ever wait for each other.
    """
    head = _locked_head(db)
    entry = AuditEntry(
        seq=head.seq + 1,
        at=now,
        actor=actor,
        action=action,
        subject=subject,
        details=canonical_json(dict(details or {})),
        previous_hash=head.hash,
    )
    entry.hash = _hash(entry)
    head.seq, head.hash = entry.seq, entry.hash
    db.add(entry)
    db.flush()
    return entry


def entries_before(
    db: Session,
    *,
    before: int | None,
    limit: int,
    actor: str | None = None,
    action: str | None = None,
) -> Sequence[AuditEntry]:
    """The newest entries with a seq below `before`, newest first; filters match exactly.

    An `action` that ends with a dot takes everything that begins so, as in "login.".
    """
    query = select(AuditEntry).order_by(AuditEntry.seq.desc()).limit(limit)
    if before is not None:
        query = query.where(AuditEntry.seq < before)
    if actor:
        query = query.where(AuditEntry.actor == actor)
    if action and action.endswith("."):
        query = query.where(AuditEntry.action.startswith(action, autoescape=True))
    elif action:
        query = query.where(AuditEntry.action == action)
    return db.scalars(query).all()


def verify_trail(db: Session) -> AuditCheck:
    """Recompute every hash of the trail, and compare its end with the head."""
    previous, count = FIRST_HASH, 0
    for entry in db.scalars(select(AuditEntry).order_by(AuditEntry.seq)).yield_per(1000):
        count += 1
        intact = (
            entry.seq == count and entry.previous_hash == previous and entry.hash == _hash(entry)
        )
        if not intact:
            return AuditCheck(ok=False, entries=count, broken_at=count)
        previous = entry.hash
    head = db.get(AuditHead, _HEAD)
    end = (0, FIRST_HASH) if head is None else (head.seq, head.hash)
    if end != (count, previous):
        return AuditCheck(ok=False, entries=count, broken_at=count + 1)
    return AuditCheck(ok=True, entries=count)


def _locked_head(db: Session) -> AuditHead:
    dialect = db.get_bind().dialect.name
    insert = (postgresql if dialect == "postgresql" else sqlite).insert(AuditHead)
    db.execute(insert.values(id=_HEAD, seq=0, hash=FIRST_HASH).on_conflict_do_nothing())
    return db.scalars(
        select(AuditHead)
        .where(AuditHead.id == _HEAD)
        .with_for_update()
        .execution_options(populate_existing=True)
    ).one()


def _hash(entry: AuditEntry) -> str:
    at = entry.at.astimezone(UTC).isoformat()
    parts = [entry.seq, at, entry.actor, entry.action, entry.subject, entry.details]
    return sha256_of(canonical_json([*parts, entry.previous_hash]))
