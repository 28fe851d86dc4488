"""List the participants of a study with their sessions, copies and erasures."""

import json
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Literal, cast

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.care.rights.copies import copies_by_participant
from app.features.care.rights.schemas import (
    CopyLeft,
    CopyView,
    ErasureView,
    ParticipantSession,
    ParticipantView,
)
from app.features.record.erasure import is_overwritten
from app.models import CopyMade, Erasure, Participant, SessionEvent, Study, StudySession
from app.settings import Settings

CopyKind = Literal["export", "access", "backup"]


def participants_of(db: Session, settings: Settings, study: Study) -> list[ParticipantView]:
    """Return every participant of a study, newest first, including erased ones."""
    rows = db.scalars(
        select(Participant)
        .where(Participant.study_id == study.id)
        .order_by(Participant.created_at.desc(), Participant.code.desc())
    ).all()
    sessions: dict[str, list[ParticipantSession]] = defaultdict(list)
    # Only the columns shown: loading a thousand complete sessions would take most of the time.
    own = select(
        StudySession.participant_id,
        StudySession.id,
        StudySession.status,
        StudySession.created_at,
        StudySession.started_at,
        StudySession.ended_at,
    ).where(StudySession.study_id == study.id)
    for participant_id, *shown in db.execute(own.order_by(StudySession.created_at)):
        fields = zip(ParticipantSession.model_fields, shown, strict=True)
        sessions[participant_id].append(ParticipantSession.model_validate(dict(fields)))
    erased = {
        row.participant_id: row
        for row in db.scalars(select(Erasure).where(Erasure.study_id == study.id))
    }
    began = {person: own[0].created_at for person, own in sessions.items()}
    copies = copies_by_participant(db, study, rows, began)
    return [
        _participant(
            row, sessions[row.id], copies.get(row.id, []), _tomb(db, settings, erased, row)
        )
        for row in rows
    ]


def _tomb(
    db: Session, settings: Settings, erased: Mapping[str, Erasure], row: Participant
) -> ErasureView | None:
    return erasure_view(db, settings, erased[row.id]) if row.id in erased else None


def _participant(
    row: Participant,
    sessions: Sequence[ParticipantSession],
    copies: Sequence[CopyMade],
    erasure: ErasureView | None,
) -> ParticipantView:
    return ParticipantView(
        id=row.id,
        code=row.code,
        kind=row.kind,
        created_at=row.created_at,
        sessions=list(sessions),
        copies=[] if erasure is not None else [_left(one) for one in copies],
        erasure=erasure,
    )


def erasure_view(db: Session, settings: Settings, row: Erasure) -> ErasureView:
    """Return a tombstone with the current state of the copies that it lists."""
    ids = [str(one["id"]) for one in row.remaining]
    current = {one.id: one for one in db.scalars(select(CopyMade).where(CopyMade.id.in_(ids)))}
    return ErasureView(
        id=row.id,
        at=row.at,
        by=row.by,
        reason_code=_reason(db, row),
        removed={str(table): int(count) for table, count in row.removed.items()},
        remaining=[
            _left(current[one["id"]]) if one["id"] in current else _from_tombstone(one)
            for one in row.remaining
        ],
        overwritten=is_overwritten(settings),
    )


def copy_view(db: Session, row: CopyMade) -> CopyView:
    """Return a copy as a response model."""
    study = None if row.study_id is None else db.get(Study, row.study_id)
    return CopyView(
        **_left(row).model_dump(),
        study_key=None if study is None else study.key,
        session_kind=row.session_kind,
        sessions=row.sessions,
        bytes=row.bytes,
        by=row.by,
    )


def _left(row: CopyMade) -> CopyLeft:
    return CopyLeft(
        id=row.id,
        kind=cast("CopyKind", row.kind),
        place=row.place,
        at=row.at,
        destroyed_at=row.destroyed_at,
        destroyed_by=row.destroyed_by,
    )


def _from_tombstone(one: Mapping[str, str]) -> CopyLeft:
    """Return a copy that is only in the tombstone, because the database is from an older backup."""
    return CopyLeft.model_validate({**one, "destroyed_at": None, "destroyed_by": None})


def _reason(db: Session, row: Erasure) -> str:
    """Return the reason code of an erasure from the sessions' event logs."""
    event = db.scalar(
        select(SessionEvent).where(
            SessionEvent.session_id.in_([str(one) for one in row.sessions]),
            SessionEvent.type == "data_erased",
        )
    )
    return "" if event is None else str(json.loads(event.payload)["reason_code"])
