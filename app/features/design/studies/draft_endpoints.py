"""Writing a study over HTTP: templates, checks, changes of a form, dry runs. Nothing is stored."""

from typing import Any

from fastapi import APIRouter

from app.features.design.studies.comparing import compare_draft
from app.features.design.studies.drafts import check, dry_run, edit, templates
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
    """Studies to begin with."""
    return list(templates())


@router.get("/study-schema")
def get_schema(_: SignedIn) -> dict[str, Any]:
    """The JSON schema of study files, from which the editor makes its form."""
    return dict(study_schema())


@router.post("/studies/check")
def post_check(file: StudyFile, db: Reading, _: SignedIn) -> CheckResult:
    """Check a file without storing it."""
    return check(db, file.yaml)


@router.post("/studies/edit")
def post_edit(request: EditRequest, _: SignedIn) -> EditedFile:
    """Change values of a text by their paths; comments and layout of the rest stay."""
    return EditedFile(yaml=edit(request.yaml, request.changes))


@router.post("/studies/timeline")
def post_timeline(request: TimelineRequest, db: Reading, _: SignedIn) -> TimelineView:
    """A dry run of one participant."""
    return dry_run(db, request)


@router.post("/studies/{key}/diff")
def post_diff(key: str, draft: DraftFile, db: Reading, _: SignedIn) -> StudyDiff:
    """What a draft would change in the newest version."""
    return compare_draft(db, study_by_key(db, key), draft.yaml)
