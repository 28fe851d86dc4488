"""Copies of data that leave the database are put on record: an erasure cannot reach them."""

from datetime import datetime

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.models import CopyMade, Study, StudySession

LONGEST_PLACE = 400
COMMAND_LINE = "command line"
"""Who makes a copy with a command: nobody is signed in there."""


def record_copy(
    db: Session,
    *,
    kind: str,
    place: str,
    by: str,
    now: datetime,
    study_id: str | None = None,
    session_kind: str | None = None,
    participant_id: str | None = None,
    sessions: int | None = None,
    size_bytes: int | None = None,
) -> CopyMade:
    """Put on record that a copy is made: `kind` is export, access or backup.

    `session_kind`: of an export; people, simulated, test, expert or all.
    """
    row = CopyMade(
        kind=kind,
        study_id=study_id,
        session_kind=session_kind,
        participant_id=participant_id,
        place=place[-LONGEST_PLACE:],
        sessions=sessions,
        bytes=size_bytes,
        by=by,
        at=now,
    )
    db.add(row)
    db.flush()
    return row


def sessions_in(db: Session, study: Study, kind: str) -> int:
    """How many sessions an export of this kind holds."""
    query = select(func.count()).select_from(StudySession).where(StudySession.study_id == study.id)
    return db.scalar(query if kind == "all" else query.where(StudySession.kind == kind)) or 0


def in_browser_of(actor: str) -> str:
    """The place of a copy that somebody downloaded: nobody knows where they put it."""
    return f"downloaded by {actor.removeprefix('account:')}"
