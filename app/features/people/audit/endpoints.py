"""HTTP endpoints that show and verify the audit trail."""

import json
from datetime import datetime
from typing import Annotated, Any

from fastapi import APIRouter, Query
from pydantic import BaseModel

from app.features.people.audit.service import entries_before, verify_trail
from app.platform.dependencies import Reading, SignedIn

router = APIRouter(tags=["audit"])
Name = Annotated[str | None, Query(max_length=100)]


class AuditView(BaseModel):
    """An entry of the audit trail.

    `actor` is `account:NAME`, `script:NAME` for a rehearsal that the server ran for that account, a
    device, or `nobody` for a request without a login.
    """

    seq: int
    at: datetime
    actor: str
    action: str
    subject: str
    details: dict[str, Any]
    hash: str


class AuditPage(BaseModel):
    """Entries of the audit trail, newest first.

    `next_before` is the value of `before` that requests the next page, and null on the last page.
    """

    entries: list[AuditView]
    next_before: int | None


class AuditCheckView(BaseModel):
    """The result of verifying the audit trail; `broken_at` is the first entry that was altered.

    `head` is the newest entry as SEQ:HASH. If it is also stored elsewhere, it can reveal later that
    entries were removed from the end.
    """

    ok: bool
    entries: int
    head: str
    broken_at: int | None


@router.get("/audit")
def get_audit(
    db: Reading,
    _: SignedIn,
    before: Annotated[int | None, Query(ge=1, lt=2**31)] = None,
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
    actor: Name = None,
    action: Name = None,
) -> AuditPage:
    """Return entries, newest first; an `action` that ends with a dot matches as a prefix."""
    rows = entries_before(db, before=before, limit=limit + 1, actor=actor, action=action)
    shown = rows[:limit]
    return AuditPage(
        entries=[
            AuditView(
                seq=row.seq,
                at=row.at,
                actor=row.actor,
                action=row.action,
                subject=row.subject,
                details=json.loads(row.details),
                hash=row.hash,
            )
            for row in shown
        ],
        next_before=shown[-1].seq if len(rows) > limit else None,
    )


@router.get("/audit/check")
def get_audit_check(db: Reading, _: SignedIn) -> AuditCheckView:
    """Verify the audit trail by recomputing the whole hash chain."""
    check = verify_trail(db)
    return AuditCheckView(
        ok=check.ok, entries=check.entries, head=str(check.head), broken_at=check.broken_at
    )
