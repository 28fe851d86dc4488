"""The audit trail: who did what to which object; append-only, hash-chained, and always enabled.

A session has its own event log; the audit trail records what happens around sessions: logins,
accounts, studies, copies of data, erasures. It contains nothing about participants, not even their
codes, because a chained entry cannot be erased.

A chain alone cannot reveal that entries were removed from its end, since the rest is still
consistent. So every backup and export carries the head of the trail (its newest entry) outside the
database: a trail that no longer contains such a head was truncated or rewritten (`contains_head`).
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from app.errors import InvalidInput
from app.models import AuditEntry, AuditHead
from app.protocol import canonical_json, sha256_of

FIRST_HASH = "0" * 64
SHORTEST_PREFIX = 16
"""The fewest hex digits of a head's hash to accept, for heads that are typed from paper."""
_HEAD = 1
_WRITTEN = re.compile(rf"([0-9]{{1,15}}):([0-9a-f]{{{SHORTEST_PREFIX},64}})", re.ASCII)


@dataclass(frozen=True)
class TrailHead:
    """The newest entry of the audit trail at some moment; `seq` 0 stands for an empty trail.

    `hash` may be only the first part of the hash, if somebody copied it from paper.
    """

    seq: int
    hash: str

    def __str__(self) -> str:
        return f"{self.seq}:{self.hash}"

    @classmethod
    def parse(cls, text: str) -> "TrailHead":
        """Parse a head in the format SEQ:HASH that `str` produces; raises InvalidInput."""
        found = _WRITTEN.fullmatch(text.strip().lower())
        if found is None:
            raise InvalidInput(
                f"{text[:100]!r} is not the head of an audit trail: that is SEQ:HASH, with at "
                f"least {SHORTEST_PREFIX} hex digits of the hash",
                value=text[:100],
                valid=f"SEQ:HASH, at least {SHORTEST_PREFIX} hex digits of the hash",
                remedy="Copy it from the output of a backup or an export, or from the README of "
                "an export.",
            )
        return cls(int(found[1]), found[2])


@dataclass(frozen=True)
class AuditCheck:
    """The result of verifying the trail; `broken_at` is the first `seq` that fails."""

    ok: bool
    entries: int
    head: TrailHead
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
    """Append an entry to the audit trail within the caller's transaction.

    Writers queue for the lock on the chain's head until their transactions end. Call this last in a
    transaction, so that two transactions can never deadlock.
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
    """Return the newest entries with a `seq` below `before`, newest first; filters match exactly.

    An `action` that ends with a dot, such as "login.", matches every action with that prefix.
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
    """Recompute every hash of the trail, and compare its last entry with the stored head."""
    found = head_of(db)
    previous, count = FIRST_HASH, 0
    for entry in db.scalars(select(AuditEntry).order_by(AuditEntry.seq)).yield_per(1000):
        count += 1
        intact = (
            entry.seq == count and entry.previous_hash == previous and entry.hash == _hash(entry)
        )
        if not intact:
            return AuditCheck(ok=False, entries=count, head=found, broken_at=count)
        previous = entry.hash
    if found != TrailHead(count, previous):
        return AuditCheck(ok=False, entries=count, head=found, broken_at=count + 1)
    return AuditCheck(ok=True, entries=count, head=found)


def head_of(db: Session) -> TrailHead:
    """Return the head of the trail as the current transaction sees it."""
    head = db.get(AuditHead, _HEAD)
    return TrailHead(0, FIRST_HASH) if head is None else TrailHead(head.seq, head.hash)


def contains_head(db: Session, head: TrailHead) -> bool:
    """Return whether the trail contains the entry that `head` names, with the same hash.

    Together with a trail that verifies, this proves that everything up to that entry is unchanged.
    It is also False after an older backup, made before that entry, was restored.
    """
    if head.seq == 0:
        return FIRST_HASH.startswith(head.hash)
    stored = db.scalar(select(AuditEntry.hash).where(AuditEntry.seq == head.seq))
    return stored is not None and stored.startswith(head.hash)


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
