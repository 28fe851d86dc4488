"""Why sessions were ended early, in the words of whoever ended them."""

import json

from sqlalchemy import ColumnElement, select
from sqlalchemy.orm import Session

from app.features.record.sessions import SessionStatus, content_body
from app.models import SessionContent, SessionEvent, StudySession

_EARLY = (SessionStatus.ABORTED, SessionStatus.WITHDRAWN)


def end_reasons(db: Session, condition: ColumnElement[bool]) -> dict[str, str]:
    """Return the reasons of the sessions that a condition selects, by the session's id.

    Sessions that were completed have none, and those whose data were erased have none any more.
    """
    ends = db.execute(
        select(SessionEvent.session_id, SessionEvent.payload)
        .join(StudySession, StudySession.id == SessionEvent.session_id)
        .where(condition, StudySession.status.in_(_EARLY), SessionEvent.type == "session_ended")
    )
    session_by_content = {
        content_id: session_id
        for session_id, payload in ends
        if (content_id := json.loads(payload).get("content_id")) is not None
    }
    contents = db.scalars(select(SessionContent).where(SessionContent.id.in_(session_by_content)))
    return {
        session_by_content[row.id]: str(content_body(row))
        for row in contents
        if row.body is not None
    }
