"""Write everything about one participant as one ZIP: a page to read, then texts and tables."""

import json
from collections.abc import Generator, Iterator
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.database import Database
from app.features.care.rights.access.page import page_of
from app.features.care.rights.access.summary import visits_of
from app.features.record.sessions import AVATAR, AVATAR_CHANGE, content_body, contents_of
from app.features.results.exports import safe_name
from app.features.results.exports.writing import Member, person_archive
from app.features.results.imports import imported_answers_of
from app.models import Participant, Study, StudySession
from app.platform.access import hidden_sessions

PAGE, WORDS, IMPORTED = "your-data.html", "words.json", "imported.json"
OF_THE_BODY = (AVATAR, AVATAR_CHANGE)
"""Kinds of content that reveal which body was worn."""


def access_name(code: str) -> str:
    """Return the file name of a participant's own copy."""
    return f"reembody_access_{safe_name(code)}.zip"


def access_archive(
    database: Database, study_key: str, participant_id: str, *, now: datetime
) -> Generator[bytes]:
    """Yield the ZIP file in pieces, from one snapshot; close the iterator to stop early."""
    with database.reading() as db:
        participant = db.get_one(Participant, participant_id)
        own = select(StudySession.id).where(StudySession.participant_id == participant_id)
        sessions = frozenset(db.scalars(own.order_by(StudySession.created_at)))
        more = _members(db, participant, now)
        # `all`: sessions of every kind belong to the participant.
        yield from person_archive(db, study_key, "all", sessions, more, now=now)


def _members(db: Session, participant: Participant, now: datetime) -> Iterator[Member]:
    page = page_of(participant.code, visits_of(db, participant), now)
    yield Member(PAGE, iter([page.encode()]))
    yield Member(WORDS, iter([_words(db, participant).encode()]))
    imported = imported_answers_of(db, participant.study_id, participant.code)
    if imported and participant.kind == "people":
        # Answers that were imported from another tool, with the same code.
        text = json.dumps(imported, ensure_ascii=False, indent=2) + "\n"
        yield Member(IMPORTED, iter([text.encode()]))


def _words(db: Session, participant: Participant) -> str:
    """Return notes, reasons, heights and corrections in their stored form, as JSON.

    While a session's condition must not be known, what was recorded of its avatars is left out,
    because it depends on the body that was worn.
    """
    sessions = db.scalars(
        select(StudySession.id)
        .where(StudySession.participant_id == participant.id)
        .order_by(StudySession.created_at, StudySession.id)
    )
    hidden = hidden_sessions(db, db.get_one(Study, participant.study_id))
    words: list[dict[str, Any]] = [
        {
            "session_id": row.session_id,
            "kind": row.kind,
            "at_utc": row.created_at.astimezone(UTC).isoformat(),
            "by": row.created_by,
            "body": content_body(row),
        }
        for session_id in sessions.all()
        for row in contents_of(db, session_id)
        if not (session_id in hidden and row.kind in OF_THE_BODY)
    ]
    return json.dumps(words, ensure_ascii=False, indent=2) + "\n"
