"""HTTP endpoints for editing a study without storing it: templates, checks, edits, dry runs."""

from typing import Any

from fastapi import APIRouter

from app.features.design.studies.comparing import compare_draft
from app.features.design.studies.drafts.service import check, dry_run, edit, templates
from app.features.design.studies.schemas import (
    CheckResult,
    DraftFile,
    EditedFile,
    EditRequest,
    StudyDiff,
    StudyFile,
    TemplateView,
    TimelineRequest,
    TimelineView,
)
from app.features.design.studies.service import study_by_key
from app.platform.dependencies import Reading, SignedIn
from app.protocol import study_schema

router = APIRouter(tags=["studies"])


@router.get("/templates")
def get_templates(_: SignedIn) -> list[TemplateView]:
    """Return studies that can be used as templates."""
    return list(templates())


@router.get("/study-schema")
def get_schema(_: SignedIn) -> dict[str, Any]:
    """Return the JSON schema of study files, from which the editor builds its form."""
    return dict(study_schema())


@router.post("/studies/check")
def post_check(file: StudyFile, db: Reading, _: SignedIn) -> CheckResult:
    """Check a study file without storing it."""
    return check(db, file.yaml)


@router.post("/studies/edit")
def post_edit(request: EditRequest, _: SignedIn) -> EditedFile:
    """Change values of a text by their paths, keeping comments and layout of the rest."""
    return EditedFile(yaml=edit(request.yaml, request.changes))


@router.post("/studies/timeline")
def post_timeline(request: TimelineRequest, db: Reading, _: SignedIn) -> TimelineView:
    """Return a dry run of one participant's visit."""
    return dry_run(db, request)


@router.post("/studies/{key}/diff")
def post_diff(key: str, draft: DraftFile, db: Reading, _: SignedIn) -> StudyDiff:
    """Return the differences of a draft from the newest version."""
    return compare_draft(db, study_by_key(db, key), draft.yaml)
