"""Endpoints for headsets: the WebSocket, the session's physics avatar, and its bodies."""

import asyncio
import logging
from typing import Annotated

from fastapi import APIRouter, Path, Response, WebSocket
from fastapi.responses import StreamingResponse
from sqlalchemy.exc import DBAPIError
from starlette.concurrency import run_in_threadpool
from starlette.websockets import WebSocketDisconnect, WebSocketState

from app.errors import InvalidInput, NotSignedIn, ReembodyError
from app.features.movement.files import BYTES, binary, sent
from app.features.movement.humanoids import BindingView, stored_binding
from app.features.record.headset.avatar import AvatarWish, SessionAvatar, prepare, record_avatar
from app.features.record.headset.bodies import require_own_body
from app.features.record.headset.connection import CLOSE_REFUSED, HeadsetConnection
from app.features.record.telemetry import TelemetryWriter
from app.platform.context import AppContext
from app.platform.dependencies import Context, PairedHeadset
from app.platform.tokens import device_of_token
from app.wire import SUBPROTOCOL, Failure, MalformedBatchError

router = APIRouter(prefix="/vr", tags=["headset"])
log = logging.getLogger(__name__)
CLOSE_NOT_PAIRED = 4401
CLOSE_TRY_AGAIN = 1013
MAX_REASON_BYTES = 123
CACHED = {"cache-control": "private, max-age=3600"}
ContentHash = Annotated[str, Path(pattern=r"^[0-9a-f]{64}$")]


@router.websocket("/stream")
async def vr_stream(socket: WebSocket) -> None:
    """Serve the WebSocket of a headset; see docs/protocol.md."""
    context: AppContext = socket.app.state.context
    try:
        await serve_headset(socket, context, context.part(TelemetryWriter))
    except asyncio.CancelledError:
        return


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


async def serve_headset(socket: WebSocket, context: AppContext, writer: TelemetryWriter) -> None:
    """Accept, authenticate and serve one headset; send the reason before closing on an error."""
    token = _token(socket)
    await socket.accept(subprotocol=SUBPROTOCOL)
    try:
        device = await asyncio.to_thread(_device_session, context, token)
        connection = HeadsetConnection(socket, context, writer, device, token)
        await connection.run()
    except (WebSocketDisconnect, asyncio.CancelledError):
        return
    except NotSignedIn as error:
        await _close(socket, CLOSE_NOT_PAIRED, error)
    except ReembodyError as error:
        await _close(socket, CLOSE_REFUSED, error)
    except MalformedBatchError as error:
        await _close(
            socket,
            CLOSE_REFUSED,
            InvalidInput(str(error), remedy="See docs/protocol.md for the layout of a batch."),
        )
    except DBAPIError:
        # The database is unavailable at the moment; the headset reconnects automatically.
        if socket.application_state is WebSocketState.CONNECTED:
            await socket.close(CLOSE_TRY_AGAIN)
    except TimeoutError:
        await _close(
            socket, CLOSE_REFUSED, InvalidInput("no hello was sent", remedy="Send hello first.")
        )


def _device_session(context: AppContext, token: str) -> str:
    with context.database.reading() as db:
        return device_of_token(db, token, "headset").session_id


def _token(socket: WebSocket) -> str:
    offered = socket.scope.get("subprotocols", [])
    tokens = [name.removeprefix("bearer.") for name in offered if name.startswith("bearer.")]
    return tokens[0] if tokens else ""


async def _close(socket: WebSocket, code: int, error: ReembodyError) -> None:
    if socket.application_state is not WebSocketState.CONNECTED:
        return
    failure = Failure(code=error.code, message=error.message, remedy=error.remedy)
    try:
        await socket.send_text(failure.model_dump_json())
        await socket.close(code, reason=_reason(error.message))
    except (RuntimeError, WebSocketDisconnect):
        log.debug("the headset disconnected before the error could be sent to it")


def _reason(message: str) -> str:
    """Truncate a message to the length that fits in a close frame."""
    return message.encode()[:MAX_REASON_BYTES].decode(errors="ignore")
