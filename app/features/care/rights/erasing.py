"""Erase a participant in one transaction, leaving only the skeleton of the record."""

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidInput, NotFound, NotNow
from app.features.care.rights.copies import copies_holding, register_found
from app.features.people.audit import record
from app.features.record.erasure import remove_traces
from app.features.record.sessions import EraseData, apply_command
from app.features.results.imports import forget_participant
from app.models import CopyMade, Erasure, ImportedForm, Participant, Study, StudySession, new_id
from app.platform.context import AppContext


def participant_of(db: Session, study: Study, participant_id: str) -> Participant:
    """Return a participant of a study; raise NotFound if there is none with this id."""
    row = db.get(Participant, participant_id)
    if row is None or row.study_id != study.id:
        raise NotFound("there is no such participant", value=participant_id)
    return row


def erasure_of(db: Session, participant_id: str) -> Erasure | None:
    """Return the tombstone of a participant, or None if their data were not erased."""
    return db.scalar(select(Erasure).where(Erasure.participant_id == participant_id))


def erase(
    db: Session,
    context: AppContext,
    participant: Participant,
    *,
    confirm: str,
    reason_code: str,
    actor: str,
) -> Erasure:
    """Erase everything about a participant; `confirm` is their code, typed again.

    Raises InvalidInput if the code is a different one, Conflict if it was done before, and NotNow
    while a session of theirs is active.
    """
    sessions = locked_sessions(db, participant)
    require_erasable(db, participant, confirm)
    now = context.clock.utc_now()
    erasure = erase_now(
        db, context, participant, sessions, erasure_id=new_id(), by=actor, at=now, why=reason_code
    )
    record(
        db,
        actor=actor,
        action="participant.erased",
        subject=f"participant:{participant.code}",
        details={
            "erasure": erasure.id,
            "reason": reason_code,
            "sessions": list(erasure.sessions),
            "removed": erasure.removed,
            "copies_left": len(erasure.remaining),
        },
        now=now,
    )
    return erasure


def require_erasable(db: Session, participant: Participant, confirm: str) -> None:
    """Raise the error with which `erase` would fail: Conflict, InvalidInput or NotNow."""
    if erasure_of(db, participant.id) is not None:
        raise Conflict(
            "the data of this participant were already erased",
            value=participant.code,
            remedy="There is nothing left to erase; the list shows what was erased.",
        )
    if confirm != participant.code:
        raise InvalidInput(
            "the typed code is not this participant's",
            value=confirm,
            valid=participant.code,
            remedy="Type the code as shown in the list, to confirm the participant.",
        )
    active = db.scalars(
        select(StudySession.id).where(
            StudySession.participant_id == participant.id, StudySession.status == "active"
        )
    ).all()
    if active:
        raise NotNow(
            "a session of this participant is active",
            value=list(active),
            valid=[],
            remedy="Withdraw the participant first, which stops the recording immediately. Then "
            "erase.",
        )


def erase_now(
    db: Session,
    context: AppContext,
    participant: Participant,
    sessions: Sequence[StudySession],
    *,
    erasure_id: str,
    by: str,
    at: datetime,
    why: str,
) -> Erasure:
    """Delete rows and texts, log the erasure, replace the code and add a tombstone.

    `sessions`: all of the participant's, from `locked_sessions`; those still running are ended.
    """
    now = context.clock.utc_now()
    removed = remove_traces(db, [session.id for session in sessions])
    for session in sessions:
        command = EraseData(erasure_id=erasure_id, reason_code=why, even_though_active=True)
        apply_command(db, context, session, command, actor=by)
    if participant.kind == "people":
        # Answers from imported files with the same code are of the same person.
        imported = forget_participant(db, participant.study_id, participant.code)
        removed |= {ImportedForm.__tablename__: imported} if imported else {}
    # The new code contains nothing of the old one.
    participant.code = f"erased-{erasure_id[:8].upper()}"
    register_found(db, context.settings, now)
    erasure = Erasure(
        id=erasure_id,
        study_id=participant.study_id,
        participant_id=participant.id,
        sessions=[session.id for session in sessions],
        removed=removed,
        remaining=[copy_left(row) for row in copies_holding(db, participant)],
        by=by,
        at=at,
    )
    db.add(erasure)
    db.flush()
    return erasure


def locked_sessions(db: Session, participant: Participant) -> list[StudySession]:
    """Lock and return every session of a participant, oldest first, after pending writes."""
    query = (
        select(StudySession)
        .where(StudySession.participant_id == participant.id)
        .order_by(StudySession.created_at, StudySession.id)
        .with_for_update()
        .execution_options(populate_existing=True)
    )
    return list(db.scalars(query))


def copy_left(row: CopyMade) -> dict[str, Any]:
    """Return a copy outside the database as an entry of a tombstone."""
    return {"id": row.id, "kind": row.kind, "place": row.place, "at": row.at.isoformat()}
