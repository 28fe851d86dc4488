"""Decide which studies, sessions and other objects a caller may see, and apply blinding.

A caller gets the same response for an object of a foreign study as for one that never existed, so
that its address discloses nothing.

Blinding is one rule, `hidden_sessions`. An order belongs to a slot of the ledger, and a slot whose
session was aborted or withdrawn is given to the next participant. So in a blinded study the order
of a slot, and with it the condition of every session that used it, is disclosed once the session
that uses it *now* is completed, or was revealed for a reason that is on record. It is never
disclosed to operators: known orders narrow down the remaining ones.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass

from sqlalchemy import ColumnElement, Select, bindparam, select, true
from sqlalchemy.orm import Session

from app.errors import NotFound
from app.models import (
    SERVERS_OWN,
    Account,
    CopyMade,
    SessionEvent,
    SlotAttempt,
    Study,
    StudyMember,
    StudySession,
    StudyVersion,
    Suggestion,
)
from app.protocol import StudyProtocol

ENDED_STATUSES = ("completed", "aborted", "withdrawn")
_BY_ID = select(StudySession).where(StudySession.id == bindparam("session_id"))
_LOCKED_BY_ID = _BY_ID.with_for_update(key_share=True)


@dataclass(frozen=True)
class Caller:
    """A signed-in person of the lab.

    `is_script`: it is a rehearsal that the server runs for that person.
    """

    account_id: str
    username: str
    role: str
    all_studies: bool = True
    is_script: bool = False

    @property
    def actor(self) -> str:
        """The caller's name in the event log and in the audit trail."""
        return f"{'script' if self.is_script else 'account'}:{self.username}"


def caller_of(account: Account, purpose: str = "browser") -> Caller:
    """Return the caller for an account, by the purpose of the login that it uses."""
    return Caller(
        account.id,
        account.username,
        account.role,
        account.all_studies,
        is_script=purpose in SERVERS_OWN,
    )


def visible_to(caller: Caller) -> ColumnElement[bool]:
    """Return the SQL condition for the rows of `studies` that the caller may see."""
    if caller.all_studies:
        return true()
    own = select(StudyMember.study_id).where(StudyMember.account_id == caller.account_id)
    return Study.id.in_(own)


def add_member(db: Session, caller: Caller, study: Study) -> None:
    """Add the caller to the members of a study that they have created, so that they can see it."""
    if not caller.all_studies:
        db.add(StudyMember(account_id=caller.account_id, study_id=study.id))
        db.flush()


def require_object(db: Session, caller: Caller, template: str, params: Mapping[str, str]) -> None:
    """Raise NotFound if the route's object belongs to a study that the caller may not see."""
    if caller.all_studies:
        return
    if template.startswith("/api/studies/{key}"):
        own = select(Study.key).where(visible_to(caller)).order_by(Study.key)
        visible_keys = list(db.scalars(own))
        if params["key"] not in visible_keys:
            raise NotFound(
                f"there is no study {params['key']!r}", value=params["key"], valid=visible_keys
            )
        return
    for name, (what, studies) in _STUDY_OF.items():
        if name in params:
            found = studies.where(_KEYS[name] == params[name], visible_to(caller))
            if db.scalar(found) is None:
                raise NotFound(f"there is no such {what}", value=params[name])


def session_by_id(db: Session, session_id: str, *, lock: bool = False) -> StudySession:
    """Return the session or raise NotFound; `lock` makes writers of the same session queue."""
    session = db.scalar(_LOCKED_BY_ID if lock else _BY_ID, {"session_id": session_id})
    if session is None:
        raise NotFound("there is no such session", value=session_id)
    return session


def is_blind(
    db: Session, caller: Caller, protocol: StudyProtocol, session: StudySession | None
) -> bool:
    """Return whether the caller must not learn the condition of a session (of any, if None)."""
    if not protocol.blinding.operator:
        return False
    if caller.role == "operator" or session is None:
        return True
    return bool(_undisclosed(db, StudySession.id == session.id))


def hidden_sessions(db: Session, study: Study, caller: Caller | None = None) -> frozenset[str]:
    """Return the ids of a study's sessions whose condition must not be disclosed.

    `caller` is the recipient; None stands for all who read results, who are never operators. Each
    version of a study has its own blinding: a session stays blinded although a newer version is
    not.
    """
    blinded = _blinded_versions(db, study)
    if not blinded:
        return frozenset()
    of_blinded = StudySession.study_version_id.in_(blinded)
    if caller is not None and caller.role == "operator":
        return frozenset(db.scalars(select(StudySession.id).where(of_blinded)))
    return _undisclosed(db, of_blinded)


def revealed_sessions(db: Session, study: Study) -> frozenset[str]:
    """Return the ids of a study's blinded, incomplete sessions whose condition is disclosed.

    A copy of the data that contains any of them is recorded as such.
    """
    blinded = _blinded_versions(db, study)
    if not blinded:
        return frozenset()
    of_blinded = StudySession.study_version_id.in_(blinded)
    open_ = select(StudySession.id).where(of_blinded, StudySession.status != "completed")
    return frozenset(db.scalars(open_)) - _undisclosed(db, of_blinded)


def _blinded_versions(db: Session, study: Study) -> list[str]:
    versions = db.execute(
        select(StudyVersion.id, StudyVersion.canonical_json).where(
            StudyVersion.study_id == study.id
        )
    )
    return [id_ for id_, text in versions if json.loads(text)["blinding"]["operator"]]


def _undisclosed(db: Session, which: ColumnElement[bool]) -> frozenset[str]:
    """Return those of the given sessions whose order is still undisclosed.

    That is: their slot is now used by a session that is neither completed nor revealed.
    """
    open_ = (which, StudySession.status != "completed")
    slot_of_session = dict(
        db.execute(
            select(SlotAttempt.session_id, SlotAttempt.slot_id)
            .join(StudySession, StudySession.id == SlotAttempt.session_id)
            .where(*open_)
        ).all()
    )
    if not slot_of_session:
        return frozenset()
    # A subquery, because a list of ids could exceed the limit on parameters.
    slots = (
        select(SlotAttempt.slot_id)
        .join(StudySession, StudySession.id == SlotAttempt.session_id)
        .where(*open_)
    )
    attempts = db.execute(
        select(SlotAttempt.slot_id, SlotAttempt.session_id, SlotAttempt.outcome)
        .where(SlotAttempt.slot_id.in_(slots))
        .order_by(SlotAttempt.opened_at)
    )
    holders: dict[str, tuple[str, str]] = {}
    for slot_id, session_id, outcome in attempts:
        # A session that gave up its slot counts as the holder only until another session takes it.
        if slot_id not in holders or holders[slot_id][1] not in ("open", "completed"):
            holders[slot_id] = (session_id, outcome)
    revealed = set(
        db.scalars(
            select(SessionEvent.session_id)
            .join(SlotAttempt, SlotAttempt.session_id == SessionEvent.session_id)
            .where(
                SlotAttempt.slot_id.in_(slots),
                SlotAttempt.outcome != "completed",
                SessionEvent.type == "blinding_lifted",
            )
        )
    )
    return frozenset(
        session_id
        for session_id, slot_id in slot_of_session.items()
        if holders[slot_id][1] != "completed" and holders[slot_id][0] not in revealed
    )


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
