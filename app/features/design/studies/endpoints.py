"""HTTP endpoints of studies: list, create, make and compare versions, duplicate and archive."""

import json
from collections.abc import Mapping
from datetime import datetime
from typing import Annotated

from fastapi import APIRouter, Query
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.database import referenced_row
from app.errors import InvalidInput, StaleVersion
from app.features.design.studies.comparing import compare_versions
from app.features.design.studies.drafts.endpoints import router as drafts
from app.features.design.studies.lifecycle import archive, duplicate, restore
from app.features.design.studies.schemas import (
    DuplicateRequest,
    NewVersion,
    StudyDiff,
    StudyFile,
    StudySummary,
    StudyView,
    VersionDetail,
    VersionView,
)
from app.features.design.studies.service import (
    add_version,
    create_study,
    newest_version,
    protocol_of,
    session_counts,
    study_by_key,
    version_by_number,
    versions_of,
)
from app.features.design.studies.versions import used_instrument
from app.features.people.audit import record
from app.models import Study, StudyVersion
from app.platform.access import Caller, add_member, is_blind, visible_to
from app.platform.dependencies import Context, Reading, SignedIn, Writing
from app.protocol import TIMED_KINDS, compile_plan, sequences, visit_time
from app.texts import chosen

router = APIRouter(tags=["studies"])
router.include_router(drafts)

VersionNumber = Annotated[int, Query(ge=1, lt=1_000_000)]


@router.get("/studies")
def get_studies(db: Reading, caller: SignedIn, *, archived: bool = False) -> list[StudySummary]:
    """Return the caller's studies in their newest version; `archived`: only archived ones."""
    condition = Study.archived_at.is_not(None) if archived else Study.archived_at.is_(None)
    studies = db.scalars(select(Study).where(condition, visible_to(caller)).order_by(Study.key))
    return [_summary(db, study, newest_version(db, study)) for study in studies]


@router.post("/studies", status_code=201)
def post_study(file: StudyFile, db: Writing, context: Context, caller: SignedIn) -> StudyView:
    """Create a study from its file."""
    now = context.clock.utc_now()
    version = create_study(db, file.yaml, now)
    return _created(db, version, caller, "study.created", now)


@router.get("/studies/{key}")
def get_study(key: str, db: Reading, caller: SignedIn) -> StudyView:
    """Return one study in full; operators of a blinded study do not get its protocol."""
    return _view(db, study_by_key(db, key), caller)


@router.post("/studies/{key}/versions", status_code=201)
def post_version(
    key: str, file: NewVersion, db: Writing, context: Context, caller: SignedIn
) -> StudyView:
    """Add a version to a study, unless one with the same content exists.

    Raises StaleVersion if somebody has saved another one since this one's editing began, and
    InvalidInput if it began with a version that does not exist.
    """
    study = study_by_key(db, key)
    newest = newest_version(db, study)
    if file.based_on is not None and file.based_on > newest.number:
        raise InvalidInput(
            f"the study {key} has no version {file.based_on}",
            value=file.based_on,
            valid=f"1 to {newest.number}",
            remedy="Name the version with which the editing began.",
        )
    if file.based_on not in (None, newest.number) and newest.source_yaml != file.yaml:
        raise StaleVersion(
            f"version {newest.number} was saved after these changes had begun, from version "
            f"{file.based_on}",
            value=file.based_on,
            valid=newest.number,
            remedy="Look at what changes from the newest version, and take over what should stay; "
            "saving again puts this text on top of it.",
        )
    now = context.clock.utc_now()
    version = add_version(db, study, file.yaml, now)
    details = {"version": version.number, "content_hash": version.content_hash}
    _note(db, caller, "study.version", study, now, details)
    return _view(db, study, caller)


@router.get("/studies/{key}/versions/{number}")
def get_version(key: str, number: int, db: Reading, _: SignedIn) -> VersionDetail:
    """Return one version of a study in full."""
    version = version_by_number(db, study_by_key(db, key), number)
    return VersionDetail(
        number=version.number,
        content_hash=version.content_hash,
        design_hash=version.design_hash,
        yaml=version.source_yaml,
        protocol=json.loads(version.canonical_json),
        instruments=version.instruments,
    )


@router.get("/studies/{key}/diff")
def get_diff(
    key: str,
    db: Reading,
    _: SignedIn,
    source: Annotated[VersionNumber, Query(alias="from")],
    target: Annotated[VersionNumber, Query(alias="to")],
) -> StudyDiff:
    """Return the differences between two versions of a study."""
    return compare_versions(db, study_by_key(db, key), source, target)


@router.post("/studies/{key}/duplicate", status_code=201)
def post_duplicate(
    key: str, request: DuplicateRequest, db: Writing, context: Context, caller: SignedIn
) -> StudyView:
    """Copy a study under another key, with a ledger of its own."""
    source = study_by_key(db, key)
    now = context.clock.utc_now()
    version = duplicate(db, source, key=request.key, title=request.title, now=now)
    return _created(db, version, caller, "study.duplicated", now, {"from": source.key})


@router.post("/studies/{key}/archive")
def post_archive(key: str, db: Writing, context: Context, caller: SignedIn) -> StudyView:
    """Archive a study: it takes no new sessions until it is restored."""
    study = study_by_key(db, key)
    now = context.clock.utc_now()
    archive(db, study, now)
    _note(db, caller, "study.archived", study, now)
    return _view(db, study, caller)


@router.post("/studies/{key}/restore")
def post_restore(key: str, db: Writing, context: Context, caller: SignedIn) -> StudyView:
    """Restore an archived study."""
    study = study_by_key(db, key)
    restore(db, study)
    _note(db, caller, "study.restored", study, context.clock.utc_now())
    return _view(db, study, caller)


def _created(
    db: Session,
    version: StudyVersion,
    caller: Caller,
    action: str,
    now: datetime,
    details: Mapping[str, object] | None = None,
) -> StudyView:
    """Give the creator of a new study access to it, record its creation and return it."""
    study = referenced_row(db, Study, version.study_id)
    add_member(db, caller, study)
    _note(db, caller, action, study, now, details)
    return _view(db, study, caller)


def _note(
    db: Session,
    caller: Caller,
    action: str,
    study: Study,
    now: datetime,
    details: Mapping[str, object] | None = None,
) -> None:
    subject = f"study:{study.key}"
    record(db, actor=caller.actor, action=action, subject=subject, details=details, now=now)


def _summary(db: Session, study: Study, version: StudyVersion) -> StudySummary:
    protocol = protocol_of(version)
    return StudySummary(
        key=study.key,
        title=chosen(protocol.title, "en"),
        titles=dict(protocol.title),
        description=chosen(protocol.description, "en"),
        descriptions=dict(protocol.description),
        version=version.number,
        content_hash=version.content_hash,
        frozen=version.frozen_at is not None,
        session_counts=session_counts(db, study),
        created_at=study.created_at,
        archived_at=study.archived_at,
    )


def _view(db: Session, study: Study, caller: Caller) -> StudyView:
    versions = versions_of(db, study)
    newest = versions[-1]
    hidden = caller.role == "operator" and is_blind(db, caller, protocol_of(newest), None)
    protocol = protocol_of(newest)
    used = {key: used_instrument(db, newest.id, key).instrument for key in newest.instruments}
    visit = visit_time(protocol, used)
    return StudyView(
        **_summary(db, study, newest).model_dump(),
        languages=list(protocol.languages),
        phases=sum(
            step.kind in TIMED_KINDS for step in compile_plan(protocol, sequences(protocol)[0])
        ),
        planned_minutes=visit.planned,
        minutes=visit.total,
        versions=[
            VersionView(
                number=version.number,
                content_hash=version.content_hash,
                created_at=version.created_at,
                frozen_at=version.frozen_at,
            )
            for version in versions
        ],
        protocol=None if hidden else json.loads(newest.canonical_json),
        yaml=None if hidden else newest.source_yaml,
    )
