"""Record copies of data that leave the database, because an erasure cannot reach them."""

from datetime import datetime

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.models import CopyMade, Study, StudySession

MAX_PLACE_LENGTH = 400
COMMAND_LINE = "command line"
"""The actor recorded for copies made by a command, where no account is signed in."""


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
    """Record that a copy is made; `kind` is export, access or backup.

    `session_kind` applies to exports: people, simulated, test, expert or all.
    """
    row = CopyMade(
        kind=kind,
        study_id=study_id,
        session_kind=session_kind,
        participant_id=participant_id,
        place=place[-MAX_PLACE_LENGTH:],
        sessions=sessions,
        bytes=size_bytes,
        by=by,
        at=now,
    )
    db.add(row)
    db.flush()
    return row


def count_sessions(db: Session, study: Study, kind: str) -> int:
    """Return how many sessions an export of this kind of session contains."""
    query = select(func.count()).select_from(StudySession).where(StudySession.study_id == study.id)
    return db.scalar(query if kind == "all" else query.where(StudySession.kind == kind)) or 0


def download_place(actor: str) -> str:
    """Return the recorded place of a downloaded copy: only who downloaded it is known."""
    return f"downloaded by {actor.removeprefix('account:')}"
