"""Endpoints for headsets: the WebSocket, the session's physics avatar, and its bodies."""

from typing import Annotated

from fastapi import APIRouter, Path, Response, WebSocket
from fastapi.responses import StreamingResponse
from starlette.concurrency import run_in_threadpool

from app.features.movement.files import BYTES, binary, sent
from app.features.movement.humanoids import BindingView, stored_binding
from app.features.record.headset.avatar import (
    AvatarWish,
    SessionAvatar,
    prepare,
    record_avatar,
    require_own_body,
)
from app.features.record.headset.connection import HeadsetConnection
from app.features.record.headset.serving import serve_headset
from app.platform.context import AppContext
from app.platform.dependencies import Context, PairedHeadset

router = APIRouter(prefix="/vr", tags=["headset"])
CACHED = {"cache-control": "private, max-age=3600"}
ContentHash = Annotated[str, Path(pattern=r"^[0-9a-f]{64}$")]


@router.websocket("/stream")
async def vr_stream(socket: WebSocket) -> None:
    """Serve the WebSocket of a headset; see docs/protocol.md."""
    await serve_headset(socket, HeadsetConnection)


@router.post("/avatar")
def post_avatar(request: AvatarWish, context: Context, headset: PairedHeadset) -> SessionAvatar:
    """Build the session's physics avatar for this participant and record it."""
    context.storage.require_storage()
    with context.database.reading() as db:
        prepared = prepare(db, headset.session_id, request)
    with context.database.writing() as db:
        record_avatar(db, context, headset.session_id, prepared, f"headset:{headset.id}")
    return prepared.avatar


@router.get(
    "/bodies/{content_hash}/file",
    response_class=StreamingResponse,
    responses={200: binary("The model's file as it was uploaded.")},
)
def get_body_file(
    content_hash: ContentHash, context: Context, headset: PairedHeadset
) -> StreamingResponse:
    """Send the file of a body that the session's avatar can wear; the headset may cache it."""
    _require_own_body(context, headset.session_id, content_hash)
    return StreamingResponse(sent(context, content_hash), media_type=BYTES, headers=CACHED)


@router.get("/bodies/{content_hash}/binding", response_model=BindingView)
async def get_body_binding(
    content_hash: ContentHash, context: Context, headset: PairedHeadset
) -> Response:
    """Return how the nodes of the body's file follow the parts of the avatar, for drawing poses."""
    await run_in_threadpool(_require_own_body, context, headset.session_id, content_hash)
    binding = await stored_binding(context, content_hash)
    return Response(binding, media_type="application/json", headers=CACHED)


def _require_own_body(context: AppContext, session_id: str, content_hash: str) -> None:
    with context.database.reading() as db:
        require_own_body(db, session_id, content_hash)
