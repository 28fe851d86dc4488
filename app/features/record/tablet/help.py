"""A participant calls the experimenter from the tablet, and is told that the call has arrived.

A call is an alarm of the session: it is on record with its times, no page can miss it, and it
stands until somebody answers it, the participant takes it back or the session ends.
"""

from typing import Literal

from sqlalchemy.orm import Session

from app.features.record.alarms import Change, Condition, open_rows, store_change
from app.features.record.sessions import SessionState
from app.models import StudySession
from app.platform.context import AppContext

CODE = "help_asked"
_OVER = ("completed", "aborted", "withdrawn")
_WORDS = {
    "asked": "The participant calls the experimenter from the tablet.",
    "taken_back": "The participant no longer needs help.",
    "answered": "The experimenter went to the participant.",
}


def help_asked(db: Session, session_id: str) -> bool:
    """Whether a call waits for an answer."""
    return any(row.code == CODE for row in open_rows(db, session_id))


def may_ask(state: SessionState) -> bool:
    """A session that has not ended has somebody who comes."""
    return state.status not in _OVER


def note_help(
    db: Session,
    context: AppContext,
    session: StudySession,
    what: Literal["asked", "taken_back", "answered"],
) -> None:
    """Put a call, its end or its answer on record; what changes nothing is not recorded."""
    change: Literal["raised", "cleared"] = "raised" if what == "asked" else "cleared"
    if store_change(
        db,
        session.id,
        Change(change, Condition(CODE, _WORDS[what]), context.clock.utc_now()),
    ):
        context.hub.publish_after_commit(db, session.id)
