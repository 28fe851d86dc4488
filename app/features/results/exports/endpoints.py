"""HTTP endpoints of exports: streamed while they are made, or made as files to download."""

from collections.abc import Collection, Mapping
from datetime import datetime

from fastapi import APIRouter
from fastapi.responses import FileResponse, StreamingResponse
from sqlalchemy import select
from sqlalchemy.orm import Session
from starlette.concurrency import run_in_threadpool

from app.errors import NotFound, NotNow
from app.features.design.studies import study_by_key
from app.features.movement.files import streamed
from app.features.people.audit import count_sessions, download_place, record, record_copy
from app.features.results.analysis import Kind
from app.features.results.exports.export_queue import ExportQueue
from app.features.results.exports.jobs import Job
from app.features.results.exports.names import archive_name
from app.features.results.exports.schemas import ExportView, ExportWish
from app.models import Participant, Study, StudySession
from app.platform.access import Caller, require_object, revealed_sessions, session_by_id
from app.platform.context import AppContext
from app.platform.dependencies import FREES_SPACE, Context, Reading, SignedIn, Writing

router = APIRouter(tags=["exports"])
MEDIA_TYPE = "application/zip"


@router.get(
    "/studies/{key}/export",
    response_class=StreamingResponse,
    responses={200: {"content": {"application/zip": {}}, "description": "A ZIP of CSV files."}},
)
def get_export(
    key: str, db: Writing, context: Context, caller: SignedIn, kind: Kind = "people"
) -> StreamingResponse:
    """Stream the study's sessions of one kind as CSV files in a ZIP."""
    # Imported here because it loads pandas, which would slow down the server's start.
    from app.features.results.exports.writing import study_archive

    study = study_by_key(db, key)
    now = context.clock.utc_now()
    _record_copy(
        *(db, caller.actor, study, kind, now, {"kind": kind}),
        revealed=_revealed(db, study, kind),
        sessions=count_sessions(db, study, kind),
    )
    pieces = study_archive(context.database, study.key, kind, now=now)
    name = archive_name(study.key, kind, now.date())
    return StreamingResponse(
        streamed(pieces),
        media_type="application/zip",
        headers={"content-disposition": f'attachment; filename="{name}"'},
    )


@router.post("/studies/{key}/exports", status_code=202)
def post_export(
    key: str, request: ExportWish, db: Reading, context: Context, caller: SignedIn
) -> ExportView:
    """Start an export of sessions of one kind, or of one session, as a ZIP of CSV files."""
    study = study_by_key(db, key)
    what = request.kind if request.session_id is None else _code_of(db, study.id, request)
    now = context.clock.utc_now()
    job = Job(
        owner=caller.account_id,
        study_key=study.key,
        kind=request.kind,
        session_id=request.session_id,
        movement=request.movement,
        file_name=archive_name(
            study.key, what if request.movement else f"{what}_tables", now.date()
        ),
        asked_at=now,
        folder=context.part(ExportQueue).folder,
    )
    return context.part(ExportQueue).order(job)


@router.get("/exports")
def get_exports(context: Context, caller: SignedIn) -> list[ExportView]:
    """Return the caller's exports, newest first: queued, in progress, ready or failed."""
    return context.part(ExportQueue).exports_of(caller.account_id)


@router.get("/exports/{export_id}")
def get_one_export(export_id: str, context: Context, caller: SignedIn) -> ExportView:
    """Return the progress of one export."""
    return context.part(ExportQueue).view(caller.account_id, export_id)


@router.delete("/exports/{export_id}", status_code=204)
def delete_export(export_id: str, context: Context, caller: SignedIn) -> None:
    """Cancel an export, or remove its file."""
    context.part(ExportQueue).cancel(caller.account_id, export_id)


@router.get(
    "/exports/{export_id}/file",
    dependencies=[FREES_SPACE],
    response_class=FileResponse,
    responses={200: {"content": {MEDIA_TYPE: {}}, "description": "A ZIP of CSV files."}},
)
async def get_export_file(export_id: str, context: Context, caller: SignedIn) -> FileResponse:
    """Download the file; an interrupted download can be resumed (`Range`, `If-Range`)."""
    job = await run_in_threadpool(_ready, context, caller, export_id)
    if not job.recorded:
        async with context.database.writing_async() as db:
            await run_in_threadpool(_record_job_copy, db, context, caller, job)
    job.recorded, job.fetched_at = True, context.clock.utc_now()
    return FileResponse(
        job.path,
        media_type=MEDIA_TYPE,
        filename=job.file_name,
        headers={"etag": f'"{job.sha256}"'},
    )


def _code_of(db: Session, study_id: str, request: ExportWish) -> str:
    """Return the participant's code of the requested session; raise NotFound if there is none."""
    session = session_by_id(db, request.session_id or "")
    if session.study_id != study_id or session.kind != request.kind:
        # The same message as for a session that never existed.
        raise NotFound("there is no such session", value=request.session_id)
    participant = db.get_one(Participant, session.participant_id)
    return participant.code


def _ready(context: AppContext, caller: Caller, export_id: str) -> Job:
    job = context.part(ExportQueue).find(caller.account_id, export_id)
    # The caller may have lost access to the study after ordering the export.
    with context.database.reading() as db:
        require_object(db, caller, "/api/studies/{key}", {"key": job.study_key})
    if job.state != "ready":
        raise NotNow(
            "this export is not ready",
            value=job.state,
            valid=["ready"],
            remedy="Wait until it is ready; if it failed, start the export again.",
        )
    return job


def _record_job_copy(db: Session, context: AppContext, caller: Caller, job: Job) -> None:
    study, now = study_by_key(db, job.study_key), context.clock.utc_now()
    details = {"kind": job.kind, "session": job.session_id}
    _record_copy(
        *(db, caller.actor, study, job.kind, now, details),
        revealed=job.revealed,
        sessions=job.sessions,
        size_bytes=job.size_bytes,
    )


def _record_copy(
    db: Session,
    actor: str,
    study: Study,
    kind: Kind,
    now: datetime,
    details: Mapping[str, str | None],
    *,
    revealed: Collection[str],
    sessions: int,
    size_bytes: int | None = None,
) -> None:
    """Record the copy before its first byte is sent, because a broken-off download is a copy, too.

    `revealed`: open sessions of a blinded study whose condition the copy shows.
    """
    record_copy(
        db,
        kind="export",
        study_id=study.id,
        session_kind=kind,
        place=download_place(actor),
        by=actor,
        now=now,
        sessions=sessions,
        size_bytes=size_bytes,
    )
    subject = f"study:{study.key}"
    all_details = {**details, **({"revealed": sorted(revealed)} if revealed else {})}
    record(db, actor=actor, action="study.exported", subject=subject, details=all_details, now=now)


def _revealed(db: Session, study: Study, kind: Kind) -> frozenset[str]:
    revealed = revealed_sessions(db, study)
    if not revealed:
        return revealed
    of_kind = StudySession.kind == kind if kind != "all" else StudySession.kind != "expert"
    return revealed & frozenset(db.scalars(select(StudySession.id).where(of_kind)))
