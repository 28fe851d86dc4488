"""Texts stored separately from the event log, so that they can be erased without breaking it.

An event contains the content's id and sha256(salt + body). Without the salt the hash reveals
nothing about the text; erasing body and salt leaves a chain that still verifies.
"""

import hashlib
import json
import secrets
from datetime import datetime

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.record.sessions.engine import ContentRef
from app.models import SessionContent


def store_content(
    db: Session, *, session_id: str, kind: str, body: object, by: str, now: datetime
) -> ContentRef:
    """Store `body` (JSON-serialisable) and return the reference that an event may contain."""
    salt = secrets.token_hex(32)
    text = json.dumps(body, ensure_ascii=False, sort_keys=True)
    row = SessionContent(
        session_id=session_id, kind=kind, salt=salt, body=text, created_at=now, created_by=by
    )
    db.add(row)
    db.flush()
    return ContentRef(row.id, salted_hash(salt, text))


def salted_hash(salt: str, text: str) -> str:
    """Return the salted hash of a content's text, as events contain it."""
    return hashlib.sha256(f"{salt}{text}".encode()).hexdigest()


def contents_of(db: Session, session_id: str, kind: str | None = None) -> list[SessionContent]:
    """Return the contents of a session, oldest first, of one kind or of all kinds."""
    query = select(SessionContent).where(SessionContent.session_id == session_id)
    if kind is not None:
        query = query.where(SessionContent.kind == kind)
    return list(db.scalars(query.order_by(SessionContent.created_at, SessionContent.id)))


def content_body(row: SessionContent) -> object:
    """Return the stored body of a content, or None if it was erased."""
    return None if row.body is None else json.loads(row.body)
