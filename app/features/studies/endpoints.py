"""Studies over HTTP: listing, checking files, making versions."""

import json

from fastapi import APIRouter
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import InvalidConfig
from app.features.dependencies import Context, Reading, SignedIn, Writing
from app.features.studies.schemas import (
    CheckResult,
    StudyFile,
    StudySummary,
    StudyView,
    VersionView,
)
from app.features.studies.service import (
    add_version,
    check_study,
    create_study,
    newest_version,
    protocol_of,
    session_counts,
    study_by_key,
    versions_of,
)
from app.models import Study, StudyVersion

router = APIRouter(tags=["studies"])


@router.get("/studies")
def get_studies(db: Reading, _: SignedIn) -> list[StudySummary]:
    """All studies with their newest version."""
    studies = db.scalars(select(Study).where(Study.archived_at.is_(None)).order_by(Study.key))
    return [_summary(db, study, newest_version(db, study)) for study in studies]


@router.post("/studies", status_code=201)
def post_study(file: StudyFile, db: Writing, context: Context, _: SignedIn) -> StudyView:
    """Create a study from its file."""
    version = create_study(db, file.yaml, context.clock.utc_now())
    return _view(db, db.get_one(Study, version.study_id))


@router.post("/studies/check")
def post_check(file: StudyFile, db: Reading, _: SignedIn) -> CheckResult:
    """Check a file without storing it."""
    try:
        loaded = check_study(db, file.yaml)
    except InvalidConfig as error:
        return CheckResult(ok=False, problems=[dict(problem) for problem in error.details])
    return CheckResult(ok=True, key=loaded.protocol.key, content_hash=loaded.content_hash)


@router.get("/studies/{key}")
def get_study(key: str, db: Reading, _: SignedIn) -> StudyView:
    """One study in full."""
    return _view(db, study_by_key(db, key))


@router.post("/studies/{key}/versions", status_code=201)
def post_version(
    key: str, file: StudyFile, db: Writing, context: Context, _: SignedIn
) -> StudyView:
    """Make a version of a study; the same content gives the version that has it."""
    study = study_by_key(db, key)
    add_version(db, study, file.yaml, context.clock.utc_now())
    return _view(db, study)


def _summary(db: Session, study: Study, version: StudyVersion) -> StudySummary:
    protocol = protocol_of(version)
    return StudySummary(
        key=study.key,
        title=protocol.title.get("en") or next(iter(protocol.title.values())),
        description=protocol.description.get("en") or next(iter(protocol.description.values())),
        version=version.number,
        content_hash=version.content_hash,
        frozen=version.frozen_at is not None,
        session_counts=session_counts(db, study),
        created_at=study.created_at,
    )


def _view(db: Session, study: Study) -> StudyView:
    versions = versions_of(db, study)
    newest = versions[-1]
    return StudyView(
        **_summary(db, study, newest).model_dump(),
        languages=list(protocol_of(newest).languages),
        versions=[
            VersionView(
                number=version.number,
                content_hash=version.content_hash,
                created_at=version.created_at,
                frozen_at=version.frozen_at,
            )
            for version in versions
        ],
        protocol=json.loads(newest.canonical_json),
        yaml=newest.source_yaml,
    )
