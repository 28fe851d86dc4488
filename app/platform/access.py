"""Which studies, sessions and other objects a person may know of, and who is kept blind.

What is not theirs does not exist for them: a foreign object is answered like one that was never
there, so its address tells nothing.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from sqlalchemy import ColumnElement, Select, bindparam, select, true
from sqlalchemy.orm import Session

from app.errors import NotFound
from app.models import (
    Account,
    CopyMade,
    SessionEvent,
    Study,
    StudyMember,
    StudySession,
    StudyVersion,
    Suggestion,
)
from app.protocol import StudyProtocol

OVER = ("completed", "aborted", "withdrawn")
_BY_ID = select(StudySession).where(StudySession.id == bindparam("session_id"))
_LOCKED_BY_ID = _BY_ID.with_for_update(key_share=True)


@dataclass(frozen=True)
class Caller:
    """A person of the lab; `actor` is how the record names them."""

    account_id: str
    username: str
    role: str
    all_studies: bool = True

    @property
    def actor(self) -> str:
        """The name in the event log."""
        return f"account:{self.username}"


def caller_of(account: Account) -> Caller:
    """The person behind an account."""
    return Caller(account.id, account.username, account.role, account.all_studies)


def is_theirs(caller: Caller) -> ColumnElement[bool]:
    """The condition under which a row of `studies` is the caller's to see."""
    if caller.all_studies:
        return true()
    own = select(StudyMember.study_id).where(StudyMember.account_id == caller.account_id)
    return Study.id.in_(own)


def add_member(db: Session, caller: Caller, study: Study) -> None:
    """Let the caller see a study they have made."""
    if not caller.all_studies:
        db.add(StudyMember(account_id=caller.account_id, study_id=study.id))
        db.flush()


def require_object(db: Session, caller: Caller, template: str, params: Mapping[str, str]) -> None:
    """Raise NotFound where the route's object belongs to a study that is not the caller's."""
    if caller.all_studies:
        return
    if template.startswith("/api/studies/{key}"):
        own = select(Study.key).where(is_theirs(caller)).order_by(Study.key)
        known = list(db.scalars(own))
        if params["key"] not in known:
            raise NotFound(f"there is no study {params['key']!r}", value=params["key"], valid=known)
        return
    for name, (what, studies) in _STUDY_OF.items():
        if name in params:
            found = studies.where(_KEYS[name] == params[name], is_theirs(caller))
            if db.scalar(found) is None:
                raise NotFound(f"there is no such {what}", value=params[name])


def session_by_id(db: Session, session_id: str, *, lock: bool = False) -> StudySession:
    """The session; `lock` makes writers of the same session queue. Raises NotFound."""
    session = db.scalar(_LOCKED_BY_ID if lock else _BY_ID, {"session_id": session_id})
    if session is None:
        raise NotFound("there is no such session", value=session_id)
    return session


def is_blind(
    db: Session, caller: Caller, protocol: StudyProtocol, session: StudySession | None
) -> bool:
    """Whether the caller must not learn the condition of a session (or of some, if None).

    In a blinded study an operator never does, not even afterwards: orders that are known tell those
    that are left. Everybody else does once the session is over, or was unblinded for a reason that
    is on record.
    """
    if not protocol.blinding.operator:
        return False
    if caller.role == "operator":
        return True
    return session is None or not (session.status in OVER or was_unblinded(db, session))


def was_unblinded(db: Session, session: StudySession) -> bool:
    """Whether somebody had this session's condition shown to them before it was over."""
    query = select(SessionEvent.seq).where(
        SessionEvent.session_id == session.id, SessionEvent.type == "blinding_lifted"
    )
    return db.scalar(query.limit(1)) is not None


_STUDY_OF: dict[str, tuple[str, Select[str]]] = {
    "session_id": (
        "session",
        select(Study.id).join(StudySession, StudySession.study_id == Study.id),
    ),
    "suggestion_id": (
        "suggestion",
        select(Study.id)
        .join(StudyVersion, StudyVersion.study_id == Study.id)
        .join(Suggestion, Suggestion.study_version_id == StudyVersion.id),
    ),
    "copy_id": ("copy", select(Study.id).join(CopyMade, CopyMade.study_id == Study.id)),
}
_KEYS = {
    "session_id": StudySession.id,
    "suggestion_id": Suggestion.id,
    "copy_id": CopyMade.id,
}
