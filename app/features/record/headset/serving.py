"""Open a headset's socket: authenticate it, serve it, and tell it the reason before it closes."""

import asyncio
import logging
from collections.abc import Callable
from typing import Protocol

from sqlalchemy.exc import DBAPIError
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from app.errors import InvalidInput, NotSignedIn, ReembodyError
from app.features.record.headset.connection import CLOSE_REFUSED
from app.features.record.telemetry import TelemetryWriter
from app.platform.context import AppContext
from app.platform.tokens import device_of_token
from app.wire import SUBPROTOCOL, Failure, MalformedBatchError

log = logging.getLogger(__name__)
CLOSE_NOT_PAIRED = 4401
CLOSE_TRY_AGAIN = 1013
MAX_REASON_BYTES = 123


class Served(Protocol):
    """What a headset's socket is open for: a session, or a self-test."""

    async def run(self) -> None:
        """Serve the socket until it closes."""
        ...


Opens = Callable[[WebSocket, AppContext, TelemetryWriter, str, str], Served]
"""Makes what is served on a socket, of a session (its id) and a headset (its token)."""


async def serve_headset(socket: WebSocket, opens: Opens) -> None:
    """Accept and authenticate a headset, and serve it until either side ends.

    On an error it is told the reason before the socket closes.
    """
    try:
        await _serve(socket, opens)
    except asyncio.CancelledError:
        return  # the server stops


async def _serve(socket: WebSocket, opens: Opens) -> None:
    context: AppContext = socket.app.state.context
    token = _token(socket)
    await socket.accept(subprotocol=SUBPROTOCOL)
    try:
        session_id = await asyncio.to_thread(_device_session, context, token)
        await opens(socket, context, context.part(TelemetryWriter), session_id, token).run()
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
