"""The audit trail: who did what to which object, appended and hash-chained, never switched off.

A session has a log of its own; this one holds what happens around sessions: logins, accounts,
studies, copies of data, erasures. It holds nothing of participants, not even their codes: what is
chained cannot be erased.

A chain alone cannot show that its end was cut off, since what is left of it still fits. So every
backup and export carries the head of the trail, its newest entry, outside the database: a trail
that no longer holds such a head was cut or written anew (`holds_head`).
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
"""Hex digits of a hash that are enough to tell heads apart, for those who type it from paper."""
_HEAD = 1
_WRITTEN = re.compile(rf"([0-9]{{1,15}}):([0-9a-f]{{{SHORTEST_PREFIX},64}})", re.ASCII)


@dataclass(frozen=True)
class TrailHead:
    """The newest entry of the trail at some moment; `seq` 0 is the trail before its first entry.

    `hash` may be the first part of one, where somebody copied it from paper.
    """

    seq: int
    hash: str

    def __str__(self) -> str:
        return f"{self.seq}:{self.hash}"

    @classmethod
    def parse(cls, text: str) -> "TrailHead":
        """A head as `str` writes it; raises InvalidInput."""
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
    """Whether the trail verifies; `broken_at` is the first seq that does not."""

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
    """The head of the trail, as the transaction sees it."""
    head = db.get(AuditHead, _HEAD)
    return TrailHead(0, FIRST_HASH) if head is None else TrailHead(head.seq, head.hash)


def holds_head(db: Session, head: TrailHead) -> bool:
    """Whether the entry that a head names is in the trail, with the hash it had then.

    Together with a trail that verifies this proves that everything up to that entry is there as it
    was written. False after a backup from before that moment was restored, too.
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
