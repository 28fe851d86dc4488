"""Endpoints for headsets: the WebSocket, and the physics avatar of the session."""

import asyncio
import logging

from fastapi import APIRouter, WebSocket
from sqlalchemy.exc import DBAPIError
from starlette.websockets import WebSocketDisconnect, WebSocketState

from app.errors import InvalidInput, NotSignedIn, ReembodyError
from app.features.record.headset.avatar import AvatarWish, SessionAvatar, prepare, record_avatar
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
