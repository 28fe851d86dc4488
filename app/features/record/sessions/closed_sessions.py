"""Whose sessions take no more data: those of participants who withdrew or whose data were erased.

A headset that was away may bring what a finished session still lacks. After a withdrawal nothing
more is taken, from wherever it comes: it is refused with the reason, and not stored.
"""

from collections.abc import Collection

from sqlalchemy import ColumnElement, select
from sqlalchemy.orm import InstrumentedAttribute, Session, aliased

from app.errors import Withdrawn
from app.models import Erasure, StudySession

RUNS = ("planned", "active")


def closed_sessions(db: Session, session_ids: Collection[str]) -> frozenset[str]:
    """Those of the sessions that take no more data.

    Until the transaction ends none of them can be erased: what it stores would be left behind.
    """
    ended: dict[str, str] = {}
    closed = set()
    rows = db.execute(
        select(StudySession.id, StudySession.status, StudySession.participant_id)
        .where(StudySession.id.in_(sorted(session_ids)))
        .order_by(StudySession.id)
        .with_for_update(read=True, key_share=True)
    )
    for session_id, status, participant_id in rows:
        if status == "withdrawn":
            closed.add(session_id)
        elif status not in RUNS:
            ended[session_id] = participant_id
    if ended:
        # Asked after the lock was there: an erasure that held it is seen.
        query = select(Erasure.participant_id).where(Erasure.participant_id.in_(ended.values()))
        erased = set(db.scalars(query))
        closed.update(one for one, participant in ended.items() if participant in erased)
    return frozenset(closed)


def erased_session(db: Session, session_id: str) -> bool:
    """Whether the data of a session's participant were erased; lock the session first."""
    query = select(StudySession.id).where(
        StudySession.id == session_id, ~not_erased(StudySession.id)
    )
    return db.scalar(query) is not None


def not_erased(session_id: InstrumentedAttribute[str]) -> ColumnElement[bool]:
    """The condition under which a row's session still has its data."""
    mine, erasure = aliased(StudySession), aliased(Erasure)
    found = (
        select(erasure.id)
        .join(mine, mine.participant_id == erasure.participant_id)
        .where(mine.id == session_id)
    )
    return ~found.exists()


def require_capture(db: Session, session_id: str) -> None:
    """Raise Withdrawn where nothing more is taken of the session's participant."""
    if closed_sessions(db, [session_id]):
        raise refusal()


def require_capture_of(db: Session, session: StudySession) -> None:
    """The same for a session that this transaction has locked."""
    erased = session.status not in RUNS and erased_session(db, session.id)
    if session.status == "withdrawn" or erased:
        raise refusal()


def refusal() -> Withdrawn:
    """What a device is told that brings data all the same."""
    return Withdrawn(
        "the participant has withdrawn: nothing more is stored of this session",
        remedy="Stop recording, and discard what this device still keeps of it.",
    )
