"""A further socket of a session's headset, beside that of its telemetry: for trackers, or a road.

News for the headset are made in other threads. They wake the socket, which sends the newest ones
and skips what is older; when there are none, it looks whether the headset is still paired.
"""

import asyncio
import time
from contextlib import suppress
from dataclasses import dataclass, field

from starlette.websockets import WebSocket

from app.features.record.telemetry import TelemetryWriter
from app.platform.context import AppContext
from app.platform.tokens import device_of_token
from app.wire import Message

PAIRING_CHECKED_S = 10.0
"""How often a socket looks whether its headset is still paired."""


@dataclass(eq=False)
class FurtherSocket:
    """An open socket of a session's headset; subclasses say what comes over it."""

    socket: WebSocket
    context: AppContext
    _writer: TelemetryWriter
    session_id: str
    token: str
    _loop: asyncio.AbstractEventLoop = field(default_factory=asyncio.get_running_loop)
    _news: asyncio.Event = field(default_factory=asyncio.Event)
    _checked_s: float = field(default_factory=time.monotonic)

    def _wake(self) -> None:
        """Look for news soon; called from any thread."""
        try:
            self._loop.call_soon_threadsafe(self._news.set)
        except RuntimeError:  # the event loop has closed, so there is no socket left
            return

    async def _wait_for_news(self) -> None:
        """Wait until woken, or for a while without news; raise once the headset is unpaired."""
        with suppress(TimeoutError):
            async with asyncio.timeout(PAIRING_CHECKED_S):
                await self._news.wait()
        if time.monotonic() - self._checked_s >= PAIRING_CHECKED_S:
            await asyncio.to_thread(self._require_pairing)
            self._checked_s = time.monotonic()
        self._news.clear()

    def _require_pairing(self) -> None:
        with self.context.database.reading() as db:
            device_of_token(db, self.token, "headset")

    async def _write(self, message: Message) -> None:
        await self.socket.send_text(message.model_dump_json())
