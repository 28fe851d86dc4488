"""Stream live poses to a console over a WebSocket.

The console answers every pose of a body that it has drawn, with any message. At most `MAX_UNDRAWN`
poses are in flight: a slow console gets fewer poses but always the latest, regardless of how much
the network and the browser would buffer. Poses of fingers are not answered. They come with those of
a body, so at most as many follow the last answer; further ones are left out.
"""

import asyncio
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from fastapi import APIRouter
from starlette.websockets import WebSocket, WebSocketDisconnect

from app.errors import NotSignedIn, ReembodyError
from app.features.record.headset import TOPICS, TOUCHES
from app.features.record.poses.setting import Setup, Touches, setup_of
from app.platform.context import AppContext
from app.platform.dependencies import authorised_caller
from app.wire import BODY_STREAMS, CODE_OF_STREAM, StreamName

router = APIRouter(tags=["sessions"])
CLOSE_NOT_SIGNED_IN = 4401
CLOSE_REFUSED = 4403
RECHECK_S = 5.0
"""How often access is checked, so that an expired login or a revoked study is noticed."""
MAX_UNDRAWN = 4
_STREAM_BYTE = 4


@router.websocket("/sessions/{session_id}/pose")
async def show_poses(socket: WebSocket, session_id: str) -> None:
    """Stream the movement of a session live to a console."""
    try:
        await _serve(socket, socket.app.state.context, session_id)
    except asyncio.CancelledError:
        return


async def _serve(socket: WebSocket, context: AppContext, session_id: str) -> None:
    """Accept a console and stream to it until it disconnects or loses access."""
    await socket.accept()
    viewer = _Viewer(socket, context, session_id)
    try:
        await viewer.run()
    except (WebSocketDisconnect, RuntimeError):
        return
    except NotSignedIn:
        await socket.close(CLOSE_NOT_SIGNED_IN)
    except ReembodyError:
        await socket.close(CLOSE_REFUSED)


@dataclass(eq=False)
class _Viewer:
    """The connection of one console."""

    socket: WebSocket
    context: AppContext
    session_id: str
    _sent_setup: Setup | None = None
    _checked_s: float = float("-inf")
    _undrawn: int = 0
    _fingers: int = 0
    _drawn: asyncio.Event = field(default_factory=asyncio.Event)

    async def run(self) -> None:
        await self._check_access()
        sending = asyncio.create_task(self._send())
        receiving = asyncio.create_task(self._receive())
        try:
            done, _ = await asyncio.wait((sending, receiving), return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                task.result()
        finally:
            for task in (sending, receiving):
                task.cancel()
            await asyncio.gather(sending, receiving, return_exceptions=True)

    async def _receive(self) -> None:
        while True:
            received = await self.socket.receive()
            if received["type"] == "websocket.disconnect":
                raise WebSocketDisconnect(received.get("code", 1005))
            self._undrawn = max(0, self._undrawn - 1)
            self._fingers = 0
            self._drawn.set()

    async def _send(self) -> None:
        topics = (*TOPICS.values(), TOUCHES)
        with self.context.hub.subscribe(self.session_id, *topics) as subscription:
            # Covers changes made between the first access check and the subscription.
            messages: Mapping[str, Any] = {"session": None}
            while True:
                if "session" in messages or "access" in messages or self._is_due():
                    await self._check_access()
                await self._show(messages)
                await self._until_drawn()
                messages = await subscription.next(RECHECK_S)

    def _is_due(self) -> bool:
        return asyncio.get_running_loop().time() - self._checked_s >= RECHECK_S

    async def _check_access(self) -> None:
        """Raise an error if the console has lost access; send the setup if it has changed."""
        self._checked_s = asyncio.get_running_loop().time()
        setup = await asyncio.to_thread(self._setup)
        if setup != self._sent_setup:
            self._sent_setup = setup
            await self.socket.send_text(setup.model_dump_json())

    def _setup(self) -> Setup:
        caller = authorised_caller(self.socket, self.context, "WEBSOCKET")
        with self.context.database.reading() as db:
            return setup_of(db, caller, self.session_id)

    async def _show(self, messages: Mapping[str, Any]) -> None:
        blinded = self._sent_setup is None or self._sent_setup.blinded
        for message in visible(messages, blinded=blinded):
            if isinstance(message, bytes):
                if _is_body(message):
                    self._undrawn += 1
                elif self._fingers < MAX_UNDRAWN:
                    self._fingers += 1
                else:
                    continue
                await self.socket.send_bytes(message)
            else:
                await self.socket.send_text(message.model_dump_json())

    async def _until_drawn(self) -> None:
        while self._undrawn > MAX_UNDRAWN - len(BODY_STREAMS):
            self._drawn.clear()
            await self._drawn.wait()


def _is_body(message: bytes) -> bool:
    """Return whether a pose is that of a body, and not of its fingers."""
    return message[_STREAM_BYTE] <= CODE_OF_STREAM[StreamName.ACTUAL]


def visible(messages: Mapping[str, Any], *, blinded: bool) -> Iterator[bytes | Touches]:
    """Yield those messages that a console may see.

    Target and actual figure side by side reveal the latency, and so does a box that lights up after
    the participant has reached it. So a blinded console sees only the participant's own pose, with
    its fingers.
    """
    of_target = (StreamName.TARGET, StreamName.TARGET_FINGERS)
    of_actual = (StreamName.ACTUAL, StreamName.ACTUAL_FINGERS)
    for stream in of_target if blinded else (*of_target, *of_actual):
        if TOPICS[stream] in messages:
            yield messages[TOPICS[stream]]
    if blinded:
        return
    if TOUCHES in messages:
        yield Touches(touches=messages[TOUCHES])
