"""The socket that brings trackers to a headset: the newest poses, and nothing that is older."""

import asyncio
from dataclasses import dataclass

from app.errors import TakenOver
from app.features.record.headset import FurtherSocket, next_of, until_one_ends
from app.features.record.lab_trackers.service import LabTrackers, Wake
from app.wire import HEAD_POSES, TrackerPlaces, TrackersState

LEAST_INTERVAL_S = 0.002
"""Several packets that come at once, one a tracker, make one message."""


@dataclass(eq=False)
class TrackerSocket(FurtherSocket):
    """An open socket of a session's headset, over which trackers come."""

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

    async def _read(self, trackers: LabTrackers) -> None:
        while True:
            head = await next_of(self.socket, HEAD_POSES)
            trackers.take_head(self.session_id, head.poses)

    async def _send(self, trackers: LabTrackers, wake: Wake) -> None:
        self._news.set()
        while True:
            await self._wait_for_news()
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
