"""The audit trail as a page sees it."""

from datetime import datetime
from typing import Any

from pydantic import BaseModel


class AuditView(BaseModel):
    """One act. `actor` is `account:NAME`, a device, or `nobody` before a login."""

    seq: int
    at: datetime
    actor: str
    action: str
    subject: str
    details: dict[str, Any]
    hash: str


class AuditPage(BaseModel):
    """Entries, newest first; `next_before` asks for the page behind, and is null at the end."""

    entries: list[AuditView]
    next_before: int | None


class AuditCheckView(BaseModel):
    """Whether every entry is as it was written; `broken_at` is the first that is not."""

    ok: bool
    entries: int
    broken_at: int | None
