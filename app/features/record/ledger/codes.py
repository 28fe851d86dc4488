"""Participants and their codes: pseudonyms, each used by one person of a study."""

import re
from datetime import datetime

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidInput
from app.models import Erasure, Participant, StudySession

_CODE = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,39}")
_PREFIX = {"people": "P", "simulated": "SIM", "test": "TEST", "expert": "EXPERT"}


def find_or_add_participant(
    db: Session, *, study_id: str, kind: str, code: str | None, now: datetime
) -> Participant:
    """Return the participant with this code, or add one; without a code, use the next free one.

    Raises InvalidInput for an invalid code, and Conflict if that participant is in a session or has
    completed one, or if only the case of letters tells the code from that of somebody else.
    """
    if code is None or not code.strip():
        return _add_participant(db, study_id, kind, _next_code(db, study_id, kind), now)
    code = code.strip()
    if not is_code(code):
        raise InvalidInput(
            f"{code!r} cannot be a participant's code",
            value=code,
            valid="1 to 40 letters, digits, - and _",
            remedy="Use a pseudonym such as P-0007, never a name.",
        )
    existing = db.scalar(
        select(Participant).where(
            Participant.study_id == study_id, Participant.kind == kind, Participant.code == code
        )
    )
    if existing is None:
        _require_unlike(db, study_id, kind, code)
        return _add_participant(db, study_id, kind, code, now)
    if db.scalar(select(Erasure.id).where(Erasure.participant_id == existing.id)) is not None:
        raise Conflict(
            f"the data of {code} were erased, and no session can be added to an erased participant",
            value=code,
            remedy="Use another code.",
        )
    busy = db.scalar(
        select(StudySession).where(
            StudySession.participant_id == existing.id,
            StudySession.status.in_(("planned", "active", "completed")),
        )
    )
    if busy is not None:
        raise Conflict(
            f"participant {code} has a session that is {busy.status}",
            value=code,
            remedy="Open that session, or use another code.",
            details=[{"session_id": busy.id, "status": busy.status}],
        )
    return existing


def _require_unlike(db: Session, study_id: str, kind: str, code: str) -> None:
    """Raise Conflict if another code of the study differs in upper and lower case only."""
    alike = db.scalar(
        select(Participant.code).where(
            Participant.study_id == study_id,
            Participant.kind == kind,
            func.lower(Participant.code) == code.lower(),
        )
    )
    if alike is not None:
        raise Conflict(
            f"{code} differs from the participant {alike} in upper and lower case only",
            value=code,
            valid=alike,
            remedy=f"Write {alike} for the same person, or use another code for somebody else.",
        )


def is_code(code: str) -> bool:
    """Return whether `code` is a valid participant code."""
    return _CODE.fullmatch(code) is not None


def _add_participant(
    db: Session, study_id: str, kind: str, code: str, now: datetime
) -> Participant:
    row = Participant(study_id=study_id, kind=kind, code=code, created_at=now)
    db.add(row)
    db.flush()
    return row


def _next_code(db: Session, study_id: str, kind: str) -> str:
    taken = set(
        db.scalars(
            select(Participant.code).where(
                Participant.study_id == study_id, Participant.kind == kind
            )
        )
    )
    number = len(taken) + 1
    while f"{_PREFIX[kind]}-{number:04d}" in taken:
        number += 1
    return f"{_PREFIX[kind]}-{number:04d}"
