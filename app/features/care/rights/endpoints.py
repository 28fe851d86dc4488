"""HTTP endpoints of participants' rights: access copies, corrections and erasure."""

from fastapi import APIRouter
from fastapi.responses import StreamingResponse
from sqlalchemy import select
from sqlalchemy.orm import Session
from starlette.concurrency import run_in_threadpool

from app.features.care.rights.copies import copies_of_study, mark_destroyed
from app.features.care.rights.corrections import correct
from app.features.care.rights.erasing import erase, erasure_of, participant_of, require_erasable
from app.features.care.rights.participants import copy_view, erasure_view, participants_of
from app.features.care.rights.schemas import (
    CopyView,
    ErasureRequest,
    ErasureView,
    NewCorrection,
    ParticipantView,
)
from app.features.care.rights.service import keep_tombstones
from app.features.design.studies import study_by_key
from app.features.movement.files import streamed
from app.features.people.audit import download_place, record, record_copy
from app.features.record.erasure import mark_erasure, overwrite
from app.features.record.questionnaires import StoredAnswers, stored_answers
from app.features.results.analysis import Drawings
from app.features.results.exports import ExportQueue
from app.models import Study, StudySession
from app.platform.access import revealed_sessions, session_by_id
from app.platform.context import AppContext
from app.platform.dependencies import FREES_SPACE, Context, Reading, SignedIn, Writing

router = APIRouter(tags=["rights"])


@router.get("/studies/{key}/participants")
def get_participants(key: str, db: Reading, context: Context, _: SignedIn) -> list[ParticipantView]:
    """Return the participants, newest first, with their sessions; erased ones as tombstones."""
    return participants_of(db, context.settings, study_by_key(db, key))


@router.post(
    "/studies/{key}/participants/{participant_id}/erasure",
    status_code=201,
    dependencies=[FREES_SPACE],
)
async def post_erasure(
    key: str, participant_id: str, request: ErasureRequest, context: Context, caller: SignedIn
) -> ErasureView:
    """Erase everything about a participant; only the fact that there were sessions remains."""
    await run_in_threadpool(_expect, context, key, participant_id, request.confirm)
    async with context.database.writing_async() as db:

        def in_transaction() -> None:
            participant = participant_of(db, study_by_key(db, key), participant_id)
            erase(
                db,
                context,
                participant,
                confirm=request.confirm,
                reason_code=request.reason_code,
                actor=caller.actor,
            )

        await run_in_threadpool(in_transaction)
    # Exported files that were not downloaded yet, and figures, may contain what was erased.
    await run_in_threadpool(context.part(ExportQueue).forget_study, key)
    await run_in_threadpool(context.part(Drawings).forget, key)
    return await run_in_threadpool(_finished, context, participant_id)


def _expect(context: AppContext, key: str, participant_id: str, confirm: str) -> None:
    """Check that the erasure is allowed, then note that bytes will have to be overwritten."""
    with context.database.reading() as db:
        participant = participant_of(db, study_by_key(db, key), participant_id)
        require_erasable(db, participant, confirm)
    mark_erasure(context.settings)


def _finished(context: AppContext, participant_id: str) -> ErasureView:
    """Complete the list of erasures and overwrite the bytes, after the rows were deleted."""
    try:
        keep_tombstones(context)
    finally:
        overwrite(context.database, context.settings)
    with context.database.reading() as db:
        erasure = erasure_of(db, participant_id)
        assert erasure is not None  # noqa: S101 - committed above
        return erasure_view(db, context.settings, erasure)


@router.get(
    "/studies/{key}/participants/{participant_id}/access",
    response_class=StreamingResponse,
    responses={200: {"content": {"application/zip": {}}, "description": "A ZIP."}},
)
def get_access(
    key: str, participant_id: str, db: Writing, context: Context, caller: SignedIn
) -> StreamingResponse:
    """Download everything about one participant as a ZIP: a page to read, and the data."""
    # Imported here because it loads pandas, which would slow down the server's start.
    from app.features.care.rights.access.archive import access_archive, access_name

    study = study_by_key(db, key)
    participant = participant_of(db, study, participant_id)
    now = context.clock.utc_now()
    copy = record_copy(
        db,
        kind="access",
        study_id=study.id,
        session_kind=participant.kind,
        participant_id=participant.id,
        place=download_place(caller.actor),
        by=caller.actor,
        now=now,
    )
    record(
        db,
        actor=caller.actor,
        action="participant.copied",
        subject=f"participant:{participant.id}",
        details={"copy": copy.id, "study": study.key, **_revealed(db, study, participant.id)},
        now=now,
    )
    pieces = access_archive(context.database, study.key, participant.id, now=now)
    name = access_name(participant.code)
    return StreamingResponse(
        streamed(pieces),
        media_type="application/zip",
        headers={"content-disposition": f'attachment; filename="{name}"'},
    )


def _revealed(db: Session, study: Study, participant_id: str) -> dict[str, list[str]]:
    """Return the participant's open sessions whose condition the copy reveals."""
    own = select(StudySession.id).where(StudySession.participant_id == participant_id)
    revealed = revealed_sessions(db, study) & frozenset(db.scalars(own))
    return {"revealed": sorted(revealed)} if revealed else {}


@router.post("/sessions/{session_id}/submissions/{submission_id}/corrections", status_code=201)
def post_correction(
    session_id: str,
    submission_id: str,
    request: NewCorrection,
    db: Writing,
    context: Context,
    caller: SignedIn,
) -> StoredAnswers:
    """Correct an answer: the first value is kept, and the scores are computed again."""
    session = session_by_id(db, session_id, lock=True)
    correct(
        db,
        context,
        session,
        submission_id,
        item=request.item,
        value=request.value,
        reason=request.reason,
        actor=caller.actor,
    )
    return next(form for form in stored_answers(db, session) if form.submission_id == submission_id)


@router.get("/studies/{key}/copies")
def get_copies(key: str, db: Reading, _: SignedIn) -> list[CopyView]:
    """Return copies of the study's data that left the database, and all backups, newest first."""
    return [copy_view(db, row) for row in copies_of_study(db, study_by_key(db, key).id)]


@router.post("/copies/{copy_id}/destroyed")
def post_destroyed(copy_id: str, db: Writing, context: Context, caller: SignedIn) -> CopyView:
    """Record that a copy was destroyed; repeating it changes nothing."""
    now = context.clock.utc_now()
    return copy_view(db, mark_destroyed(db, copy_id, actor=caller.actor, now=now))
