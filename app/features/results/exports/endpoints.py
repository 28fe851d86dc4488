"""Exports over HTTP."""

from collections.abc import AsyncIterator, Generator
from typing import Any

from fastapi import APIRouter
from fastapi.responses import StreamingResponse
from starlette.concurrency import iterate_in_threadpool, run_in_threadpool

from app.features.design.studies.service import study_by_key
from app.features.people.audit.copies import in_browser_of, record_copy, sessions_in
from app.features.people.audit.service import record
from app.features.results.analysis.schemas import Kind
from app.features.results.exports.names import archive_name
from app.platform.dependencies import Context, SignedIn, Writing

router = APIRouter(tags=["exports"])


@router.get(
    "/studies/{key}/export",
    response_class=StreamingResponse,
    responses={200: {"content": {"application/zip": {}}, "description": "A ZIP of CSV files."}},
)
def get_export(
    key: str, db: Writing, context: Context, caller: SignedIn, kind: Kind = "people"
) -> StreamingResponse:
    """The study's sessions of one kind as CSV files in a ZIP, sent while it is made."""
    # Loads pandas, which the start of the server need not wait for.
    from app.features.results.exports.service import study_archive

    study = study_by_key(db, key)
    now = context.clock.utc_now()
    # Before it is sent: one that breaks off has left the database, too.
    record_copy(
        db,
        kind="export",
        study_id=study.id,
        session_kind=kind,
        place=in_browser_of(caller.actor),
        by=caller.actor,
        now=now,
        sessions=sessions_in(db, study, kind),
    )
    record(
        db,
        actor=caller.actor,
        action="study.exported",
        subject=f"study:{study.key}",
        details={"kind": kind},
        now=now,
    )
    pieces = study_archive(context.database, study.key, kind, now=now)
    name = archive_name(study.key, kind, now.date())
    return StreamingResponse(
        _sent(pieces),
        media_type="application/zip",
        headers={"content-disposition": f'attachment; filename="{name}"'},
    )


async def _sent(pieces: Generator[bytes, Any, None]) -> AsyncIterator[bytes]:
    try:
        async for piece in iterate_in_threadpool(pieces):
            yield piece
    finally:
        # Also when the reader has gone away: the look at the database must end.
        await run_in_threadpool(pieces.close)
