"""List the participants of a study with their sessions, copies and erasures."""

import json
from collections import defaultdict
from collections.abc import Mapping
from datetime import datetime
from typing import Any, Literal, cast

from sqlalchemy import Row, select
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
    # Only the columns shown: loading a thousand complete rows would take most of the time.
    rows = db.execute(
        select(Participant.id, Participant.code, Participant.kind, Participant.created_at)
        .where(Participant.study_id == study.id)
        .order_by(Participant.created_at.desc(), Participant.code.desc())
    ).all()
    sessions: dict[str, list[ParticipantSession]] = defaultdict(list)
    own = select(
        StudySession.participant_id,
        StudySession.id,
        StudySession.status,
        StudySession.created_at,
        StudySession.started_at,
        StudySession.ended_at,
    ).where(StudySession.study_id == study.id)
    for row in db.execute(own.order_by(StudySession.created_at)):
        participant_id, id_, status, created_at, started_at, ended_at = row
        one = ParticipantSession(
            id=id_,
            status=status,
            created_at=created_at,
            started_at=started_at,
            ended_at=ended_at,
        )
        sessions[participant_id].append(one)
    erasures = db.scalars(select(Erasure).where(Erasure.study_id == study.id)).all()
    tombs = {erased.participant_id: erasure_view(db, settings, erased) for erased in erasures}
    began = {person: own[0].created_at for person, own in sessions.items()}
    copies = copies_by_participant(db, study, {row.id: row.kind for row in rows}, began)
    views = {one: _left(one) for one in {copy for held in copies.values() for copy in held}}
    return [
        _participant(
            row,
            sessions.get(row.id, []),
            [views[one] for one in copies.get(row.id, ())],
            tombs.get(row.id),
        )
        for row in rows
    ]


def _participant(
    row: Row[str, str, Any, datetime],
    sessions: list[ParticipantSession],
    copies: list[CopyLeft],
    erasure: ErasureView | None,
) -> ParticipantView:
    return ParticipantView(
        id=row.id,
        code=row.code,
        kind=row.kind,
        created_at=row.created_at,
        sessions=sessions,
        copies=[] if erasure is not None else copies,
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
