"""Sessions that accept no more data: the participant withdrew, or their data were erased.

A headset that was offline may deliver data that a finished session still lacks. After a withdrawal
or an erasure, data from any source are rejected with the reason, and not stored.
"""

from collections.abc import Collection

from sqlalchemy import ColumnElement, select
from sqlalchemy.orm import InstrumentedAttribute, Session, aliased

from app.errors import NotNow, Withdrawn
from app.models import Erasure, StudySession

RUNS = ("planned", "active")


def closed_sessions(db: Session, session_ids: Collection[str]) -> frozenset[str]:
    """Return those of the sessions that accept no more data.

    All of them are locked against erasure until the transaction ends, because whatever the
    transaction stores would escape the erasure.
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
        # Queried after the lock was acquired, so that an erasure that held it before is seen.
        query = select(Erasure.participant_id).where(Erasure.participant_id.in_(ended.values()))
        erased = set(db.scalars(query))
        closed.update(one for one, participant in ended.items() if participant in erased)
    return frozenset(closed)


def erased_session(db: Session, session_id: str) -> bool:
    """Return whether the data of a session's participant were erased; lock the session first."""
    query = select(StudySession.id).where(
        StudySession.id == session_id, ~not_erased(StudySession.id)
    )
    return db.scalar(query) is not None


def not_erased(session_id: InstrumentedAttribute[str]) -> ColumnElement[bool]:
    """Return the SQL condition that the data of a row's session have not been erased."""
    mine, erasure = aliased(StudySession), aliased(Erasure)
    found = (
        select(erasure.id)
        .join(mine, mine.participant_id == erasure.participant_id)
        .where(mine.id == session_id)
    )
    return ~found.exists()


def require_capture(db: Session, session_id: str) -> None:
    """Raise Withdrawn if the session accepts no more data."""
    if closed_sessions(db, [session_id]):
        raise refusal()


def require_capture_of(db: Session, session: StudySession) -> None:
    """Raise Withdrawn if a session that this transaction has locked accepts no more data."""
    erased = session.status not in RUNS and erased_session(db, session.id)
    if session.status == "withdrawn" or erased:
        raise refusal()


def require_running(db: Session, session: StudySession, what: str) -> None:
    """Raise NotNow if the session has ended, so that `what` could no longer be used in it.

    For what a device asks of a session, not for data: those a finished session may still lack.
    Raises Withdrawn if the session accepts nothing at all.
    """
    require_capture_of(db, session)
    if session.status not in RUNS:
        raise NotNow(
            f"the session has ended, so {what}",
            value=session.status,
            valid=list(RUNS),
            remedy="Pair the headset with a session that is running. What its journal still has of "
            "this one is accepted on the socket.",
        )


def refusal() -> Withdrawn:
    """Return the error for a device that sends data to a closed session."""
    return Withdrawn(
        "the participant has withdrawn: nothing more of this session is stored",
        remedy="Stop recording, and discard what this device still has of it.",
    )
