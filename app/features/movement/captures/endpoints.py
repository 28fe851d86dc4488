"""HTTP endpoints of captures."""

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import StreamingResponse
from starlette.concurrency import run_in_threadpool

from app.features.movement.captures.capture_queue import CaptureQueue
from app.features.movement.captures.schemas import (
    CaptureChange,
    CapturePage,
    CaptureView,
    MetresPerUnit,
    ReadingChoice,
    Shown,
    Up,
)
from app.features.movement.captures.service import (
    UploadOptions,
    add_capture,
    change_capture,
    remove_capture,
    source_of_capture,
    store_of,
    stored_file,
)
from app.features.movement.captures.views import capture_page, capture_view
from app.features.movement.captures.worker_tasks import recorded_positions
from app.features.movement.files import BODY, BYTES, FileName, attachment, binary, sent
from app.platform.context import AppContext
from app.platform.dependencies import Context, Reading, SignedIn, Writing

router = APIRouter(prefix="/captures", tags=["captures"])


@router.post(
    "",
    status_code=201,
    openapi_extra=BODY,
    responses={200: {"model": CaptureView, "description": "The same content was already stored."}},
)
async def post_capture(
    request: Request,
    response: Response,
    context: Context,
    caller: SignedIn,
    name: FileName,
    companion: FileName | None = None,
    companion_bytes: Annotated[int | None, Query(ge=1, le=2**40)] = None,
    metres_per_unit: MetresPerUnit | None = None,
    up: Up | None = None,
) -> CaptureView:
    """Store a capture file, which is the body of the request.

    If a second file is needed (an AMC needs its ASF), it follows in the same body: its name is
    `companion`, and `companion_bytes` is its size in bytes.
    """
    options = UploadOptions(
        name, companion, companion_bytes, ReadingChoice(metres_per_unit=metres_per_unit, up=up)
    )
    capture_id, new = await add_capture(context, caller, options, request.stream())
    if not new:
        response.status_code = 200
    return await run_in_threadpool(_view, context, capture_id)


@router.get("")
def get_captures(
    db: Reading,
    _: SignedIn,
    limit: Annotated[int, Query(ge=1, le=1000)] = 200,
    offset: Annotated[int, Query(ge=0, le=2**31 - 1)] = 0,
) -> CapturePage:
    """Return the captures of the lab, newest first."""
    return capture_page(db, limit=limit, offset=offset)


@router.get("/{capture_id}")
def get_capture(capture_id: str, db: Reading, _: SignedIn) -> CaptureView:
    """Return one capture with its summary."""
    return capture_view(db, capture_id)


@router.patch("/{capture_id}")
async def patch_capture(
    capture_id: str, change: CaptureChange, context: Context, caller: SignedIn
) -> CaptureView:
    """Change the title, or parse the file again with other conventions."""
    await change_capture(context, caller, capture_id, change)
    return await run_in_threadpool(_view, context, capture_id)


@router.delete("/{capture_id}", status_code=204)
def delete_capture(capture_id: str, db: Writing, context: Context, caller: SignedIn) -> None:
    """Delete a capture, and its file unless another capture uses it."""
    remove_capture(db, context, caller, capture_id)


@router.get(
    "/{capture_id}/file",
    response_class=StreamingResponse,
    responses={200: binary("The file as it was uploaded.")},
)
def get_file(
    capture_id: str, context: Context, _: SignedIn, *, companion: bool = False
) -> StreamingResponse:
    """Download the file, or its companion, as it was uploaded."""
    name, content_hash = stored_file(context, capture_id, companion=companion)
    return StreamingResponse(
        sent(context, content_hash), media_type=BYTES, headers=attachment(name)
    )


@router.get(
    "/{capture_id}/motion",
    response_class=Response,
    responses={200: binary("Positions for a preview: docs/captures.md describes their format.")},
)
async def get_motion(
    capture_id: str, context: Context, _: SignedIn, shown: Shown = "recorded"
) -> Response:
    """Return positions over time for a preview, as recorded or of the capture's skeleton."""
    source = await run_in_threadpool(source_of_capture, context, capture_id)
    return Response(
        await context.part(CaptureQueue).run_cached(
            recorded_positions, store_of(context), source, shown
        ),
        media_type=BYTES,
    )


def _view(context: AppContext, capture_id: str) -> CaptureView:
    with context.database.reading() as db:
        return capture_view(db, capture_id)
