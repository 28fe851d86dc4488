"""The socket that brings trackers to a headset: the newest poses, and nothing that is older."""

import asyncio
from dataclasses import dataclass, field

from pydantic import ValidationError
from starlette.websockets import WebSocket

from app.errors import InvalidInput, TakenOver
from app.features.record.headset import next_message, until_one_ends
from app.features.record.lab_trackers.service import LabTrackers, Wake
from app.features.record.telemetry import TelemetryWriter
from app.platform.context import AppContext
from app.platform.tokens import device_of_token
from app.wire import HEAD_POSES, Message, TrackerPlaces, TrackersState

LEAST_INTERVAL_S = 0.002
"""Several packets that come at once, one a tracker, make one message."""
PAIRING_CHECKED_S = 10.0


@dataclass(eq=False)
class TrackerSocket:
    """An open socket of a session's headset, over which trackers come."""

    socket: WebSocket
    context: AppContext
    _writer: TelemetryWriter
    session_id: str
    token: str
    _loop: asyncio.AbstractEventLoop = field(default_factory=asyncio.get_running_loop)
    _news: asyncio.Event = field(default_factory=asyncio.Event)
    _state: TrackersState | None = None
    _sent: TrackerPlaces | None = None

    async def run(self) -> None:
        """Serve the socket until it closes."""
        trackers = self.context.part(LabTrackers)
        wake = self._wake
        await asyncio.to_thread(trackers.attach, self.session_id, wake)
        try:
            await until_one_ends(self._read(trackers), self._send(trackers, wake))
        finally:
            trackers.detach(self.session_id, wake)

    def _wake(self) -> None:
        """Look for news soon; called from any thread."""
        try:
            self._loop.call_soon_threadsafe(self._news.set)
        except RuntimeError:  # the event loop has closed, so there is no socket left
            return

    async def _read(self, trackers: LabTrackers) -> None:
        while True:
            message = await next_message(self.socket)
            try:
                head = HEAD_POSES.validate_json(message)
            except ValidationError as error:
                first = error.errors(include_url=False, include_input=False)[0]
                place = ".".join(map(str, first["loc"]))[:100]
                at = f" at {place}" if place else ""
                raise InvalidInput(
                    f"message not understood: {first['msg'][:300]}{at}",
                    value=str(message[:200]),
                    remedy="See docs/protocol.md for the messages.",
                ) from error
            trackers.take_head(self.session_id, head.poses)

    async def _send(self, trackers: LabTrackers, wake: Wake) -> None:
        self._news.set()
        while True:
            try:
                async with asyncio.timeout(PAIRING_CHECKED_S):
                    await self._news.wait()
            except TimeoutError:
                await asyncio.to_thread(self._require_pairing)
            self._news.clear()
            if not trackers.is_attached(self.session_id, wake):
                raise TakenOver(
                    "another page of this headset takes the trackers now",
                    remedy="Continue there, and close this page; to continue here, reload it.",
                )
            await self._send_newest(trackers)
            await asyncio.sleep(LEAST_INTERVAL_S)

    async def _send_newest(self, trackers: LabTrackers) -> None:
        followed = trackers.followed(self.session_id)
        now_s = self.context.clock.monotonic_ns() / 1e9
        places = None if followed is None else followed.link.places(now_s)
        state = TrackersState(wanted=followed is not None, aligned=places is not None)
        if state != self._state:
            await self._write(state)
            self._state = state
        if followed is None or places is None or places == self._sent:
            return
        await self._write(places)
        self._sent = places
        followed.link.sent(self.context.clock.monotonic_ns() / 1e9)

    async def _write(self, message: Message) -> None:
        await self.socket.send_text(message.model_dump_json())

    def _require_pairing(self) -> None:
        with self.context.database.reading() as db:
            device_of_token(db, self.token, "headset")
