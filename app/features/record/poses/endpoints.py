"""Showing poses to a console over a WebSocket.

The console answers every pose that it has drawn with any message. No more than `MOST_UNDRAWN` are
ever on the way: one that is slow gets fewer, and always the newest, however much the network and
the browser would buffer.
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
from app.platform.dependencies import admitted
from app.wire import StreamName

router = APIRouter(tags=["sessions"])
CLOSE_NOT_SIGNED_IN = 4401
CLOSE_REFUSED = 4403
LOOK_AGAIN_S = 5.0
"""A login that expires, or a study that is taken away, is noticed within this time."""
MOST_UNDRAWN = 4


@router.websocket("/sessions/{session_id}/pose")
async def show_poses(socket: WebSocket, session_id: str) -> None:
    """The movement of a session, as it comes."""
    try:
        await _serve(socket, socket.app.state.context, session_id)
    except asyncio.CancelledError:
        return


async def _serve(socket: WebSocket, context: AppContext, session_id: str) -> None:
    """Accept a console and show it the session until it goes, or may not look any more."""
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
    """One console."""

    socket: WebSocket
    context: AppContext
    session_id: str
    _told: Setup | None = None
    _looked_s: float = float("-inf")
    _undrawn: int = 0
    _drawn: asyncio.Event = field(default_factory=asyncio.Event)

    async def run(self) -> None:
        await self._look()
        talking = asyncio.create_task(self._talk())
        listening = asyncio.create_task(self._listen())
        try:
            done, _ = await asyncio.wait((talking, listening), return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                task.result()
        finally:
            for task in (talking, listening):
                task.cancel()
            await asyncio.gather(talking, listening, return_exceptions=True)

    async def _listen(self) -> None:
        while True:
            received = await self.socket.receive()
            if received["type"] == "websocket.disconnect":
                raise WebSocketDisconnect(received.get("code", 1005))
            self._undrawn = max(0, self._undrawn - 1)
            self._drawn.set()

    async def _talk(self) -> None:
        topics = (*TOPICS.values(), TOUCHES)
        with self.context.hub.subscribe(self.session_id, *topics) as subscription:
            # What has changed between the first look and now.
            news: Mapping[str, Any] = {"session": None}
            while True:
                if "session" in news or "access" in news or self._is_due():
                    await self._look()
                await self._show(news)
                await self._until_drawn()
                news = await subscription.next(LOOK_AGAIN_S)

    def _is_due(self) -> bool:
        return asyncio.get_running_loop().time() - self._looked_s >= LOOK_AGAIN_S

    async def _look(self) -> None:
        """Raise where the console may not look any more; tell the setup if it has changed."""
        self._looked_s = asyncio.get_running_loop().time()
        setup = await asyncio.to_thread(self._setup)
        if setup != self._told:
            self._told = setup
            await self.socket.send_text(setup.model_dump_json())

    def _setup(self) -> Setup:
        caller = admitted(self.socket, self.context, "WEBSOCKET")
        with self.context.database.reading() as db:
            return setup_of(db, caller, self.session_id)

    async def _show(self, news: Mapping[str, Any]) -> None:
        blinded = self._told is None or self._told.blinded
        for message in visible(news, blinded=blinded):
            if isinstance(message, bytes):
                self._undrawn += 1
                await self.socket.send_bytes(message)
            else:
                await self.socket.send_text(message.model_dump_json())

    async def _until_drawn(self) -> None:
        while self._undrawn > MOST_UNDRAWN - len(TOPICS):
            self._drawn.clear()
            await self._drawn.wait()


def visible(news: Mapping[str, Any], *, blinded: bool) -> Iterator[bytes | Touches]:
    """What of the news a console may see.

    Two figures side by side show the latency, and so does a box that lights up after the
    participant has reached it: a blinded console sees the participant alone, as they stand there.
    """
    target, actual = TOPICS[StreamName.TARGET], TOPICS[StreamName.ACTUAL]
    if target in news:
        yield news[target]
    if blinded:
        return
    if actual in news:
        yield news[actual]
    if TOUCHES in news:
        yield Touches(touches=news[TOUCHES])
