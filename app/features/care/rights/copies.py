"""List copies of data that left the database, because an erasure cannot reach them."""

from collections.abc import Mapping, Sequence
from datetime import datetime
from pathlib import Path

from sqlalchemy import ColumnElement, and_, or_, select
from sqlalchemy.orm import Session

from app.errors import NotFound
from app.features.care.backups import ENDING
from app.features.people.audit import MAX_PLACE_LENGTH, record, record_copy
from app.models import CopyMade, Participant, Study, StudySession
from app.platform.folders import backups_of
from app.platform.incomplete_files import Notes, remove_leftovers
from app.settings import Settings

FOUND_BY = "system"


def copies_of_study(db: Session, study_id: str) -> list[CopyMade]:
    """Return exports and access copies of a study, and all backups, newest first."""
    of_study = or_(CopyMade.study_id == study_id, CopyMade.study_id.is_(None))
    return list(db.scalars(select(CopyMade).where(of_study).order_by(CopyMade.at.desc())))


def copies_by_participant(
    db: Session, study: Study, kinds: Mapping[str, str], began: Mapping[str, datetime]
) -> dict[str, list[CopyMade]]:
    """Return the copies that may contain each of a study's participants.

    `kinds` maps the id of each participant to their kind, and `began` to the start of their first
    session. The result is that of
    `copies_holding` for each of them, from one query.
    """
    of_study = (CopyMade.study_id == study.id) | (CopyMade.kind == "backup")
    query = select(CopyMade).where(CopyMade.destroyed_at.is_(None), of_study)
    copies = db.scalars(query.order_by(CopyMade.at)).all()
    return {
        id_: [copy for copy in copies if copy.at >= began[id_] and _holds(copy, id_, kind)]
        for id_, kind in kinds.items()
        if id_ in began
    }


def _holds(copy: CopyMade, participant_id: str, kind: str) -> bool:
    """Apply the rule of `_may_hold` to a copy of the participant's study, or to a backup."""
    if copy.kind == "export":
        return copy.session_kind in (kind, "all")
    return copy.kind == "backup" or copy.participant_id == participant_id


def copies_holding(db: Session, participant: Participant) -> list[CopyMade]:
    """Return copies made since the participant's first session began, unless destroyed."""
    began = db.scalar(
        select(StudySession.created_at)
        .where(StudySession.participant_id == participant.id)
        .order_by(StudySession.created_at)
        .limit(1)
    )
    if began is None:
        return []
    query = select(CopyMade).where(
        CopyMade.destroyed_at.is_(None), CopyMade.at >= began, _may_hold(participant)
    )
    return list(db.scalars(query.order_by(CopyMade.at)))


def _may_hold(participant: Participant) -> ColumnElement[bool]:
    export = and_(
        CopyMade.kind == "export",
        CopyMade.study_id == participant.study_id,
        CopyMade.session_kind.in_((participant.kind, "all")),
    )
    access = and_(CopyMade.kind == "access", CopyMade.participant_id == participant.id)
    return or_(export, access, CopyMade.kind == "backup")


def register_found(db: Session, settings: Settings, now: datetime) -> Sequence[CopyMade]:
    """Record copies of the database that the product made automatically, and return their rows.

    They are backups before a migration or a restore, and databases in quarantine, in the data
    folder. Unfinished ones are recorded, too: a backup or an export in progress may see the data
    before an erasure, and one that a crash left is removed, or is on a disk that is not connected.
    """
    recorded = set(db.scalars(select(CopyMade.place).where(CopyMade.kind == "backup")))
    found = []
    for path in _files(backups_of(settings)):
        place = str(path)[-MAX_PLACE_LENGTH:]
        if place not in recorded:
            size = path.stat().st_size
            found.append(
                record_copy(db, kind="backup", place=place, by=FOUND_BY, now=now, size_bytes=size)
            )
    remove_leftovers(settings)
    for one in Notes.of(settings).all():
        place = str(one.to or one.path)[-MAX_PLACE_LENGTH:]
        if one.kind == "backup" and place not in recorded:
            found.append(record_copy(db, kind="backup", place=place, by=FOUND_BY, now=now))
        elif one.kind == "export":
            study = db.scalar(select(Study.id).where(Study.key == one.study_key))
            found.append(
                record_copy(
                    db,
                    kind="export",
                    place=place,
                    by=FOUND_BY,
                    now=now,
                    study_id=study,
                    session_kind="all",
                )
            )
    return found


def _files(backups: Path) -> list[Path]:
    home = backups.parent
    patterns = (f"backups/*{ENDING}", "quarantine/*/*.sqlite*", "quarantine/*/*-wal", "*.bak")
    return sorted({path for pattern in patterns for path in home.glob(pattern) if path.is_file()})


def mark_destroyed(db: Session, copy_id: str, *, actor: str, now: datetime) -> CopyMade:
    """Record that a copy was destroyed, once; raise NotFound if there is no such copy."""
    row = db.get(CopyMade, copy_id)
    if row is None:
        raise NotFound("there is no such copy", value=copy_id)
    if row.destroyed_at is None:
        row.destroyed_at, row.destroyed_by = now, actor
        db.flush()
        record(
            db,
            actor=actor,
            action="copy.destroyed",
            subject=f"copy:{row.id}",
            details={"kind": row.kind},
            now=now,
        )
    return row
