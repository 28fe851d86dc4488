"""The socket that shows a companion to a headset: the newest pose, and nothing that is older."""

import asyncio
from dataclasses import dataclass

from app.errors import TakenOver
from app.features.movement.performers import (
    Agreed,
    BodyFrame,
    OnBody,
    Performer,
    Performers,
    joint_map_of,
    reference_body,
)
from app.features.record.companion.frames import ShownFrame
from app.features.record.companion.placing import InRoom, Standing
from app.features.record.companion.service import Companions, Shown, Wake, name_of
from app.features.record.headset import FurtherSocket, next_of, until_one_ends
from app.features.record.sessions import Companion
from app.science.retargeting import named_stature_m
from app.science.rig import RigError
from app.wire import COMPANION_SEEN, CompanionState, companion_pose

LEAST_INTERVAL_S = 0.008
"""No headset draws more often than 120 times a second."""


@dataclass(eq=False)
class CompanionSocket(FurtherSocket):
    """An open socket of a session's headset, over which a companion's poses come."""

    _state: CompanionState | None = None
    _made_for: tuple[Agreed, Companion] | None = None
    _in_room: InRoom | None = None
    _sent: tuple[BodyFrame, Companion] | None = None

    async def run(self) -> None:
        """Serve the socket until it closes."""
        companions = self.context.part(Companions)
        wake = self._wake
        companions.attach(self.session_id, wake)
        try:
            await until_one_ends(self._read(companions), self._send(companions, wake))
        finally:
            companions.detach(self.session_id, wake)

    async def _read(self, companions: Companions) -> None:
        while True:
            said = await next_of(self.socket, COMPANION_SEEN)
            shown = companions.of(self.session_id)
            if shown is not None:
                shown.is_seen = said.seen
            # The pose in which they appear is sent also if it was sent before.
            self._sent = None
            self._wake()

    async def _send(self, companions: Companions, wake: Wake) -> None:
        await asyncio.to_thread(companions.follow, self.session_id)
        self._news.set()
        while True:
            await self._wait_for_news()
            if not companions.is_attached(self.session_id, wake):
                raise TakenOver(
                    "another page of this headset shows the companion now",
                    remedy="Continue there, and close this page; to continue here, reload it.",
                )
            shown = companions.of(self.session_id)
            companion = None if shown is None else shown.companion
            await self._tell(companion)
            if shown is not None and companion is not None and shown.is_seen:
                await self._show(companions, shown, companion)
            await asyncio.sleep(LEAST_INTERVAL_S)

    async def _tell(self, companion: Companion | None) -> None:
        """Say who the companion is, if it is somebody else."""
        state = CompanionState(chosen=False)
        if companion is not None:
            state = CompanionState(
                chosen=True,
                stature_m=named_stature_m(companion.stature) or 0.0,
                model=companion.humanoid,
                in_tasks=companion.in_tasks,
            )
        if state != self._state:
            self._state = state
            await self._write(state)

    async def _show(self, companions: Companions, shown: Shown, companion: Companion) -> None:
        """Send the performer's newest pose, if it was not sent yet."""
        performers = self.context.part(Performers)
        performer, _ = performers.used(name_of(companion))
        if performer is None:
            return
        await self._prepare(performer, companion)
        frame, in_room = performer.newest, self._in_room
        if frame is None or in_room is None or self._sent == (frame, companion):
            return
        if frame.skeleton is not in_room.body.agreed.skeleton:
            return  # it has just become another skeleton; the body follows at the next turn
        values = in_room.values(frame)
        await self.socket.send_bytes(companion_pose(values))
        self._sent = (frame, companion)
        times = (frame.source_s, frame.arrival_s, frame.mapped_s, performers.now_s())
        companions.sent(shown, companion, ShownFrame(performer.address, *times, values))

    async def _prepare(self, performer: Performer, companion: Companion) -> None:
        """Make the body anew, in a thread, if somebody or something about it is another."""
        agreed = performer.agreed
        if agreed is None or self._made_for == (agreed, companion):
            return
        self._in_room = await asyncio.to_thread(self._made, agreed, companion)
        self._made_for = (agreed, companion)

    def _made(self, agreed: Agreed, companion: Companion) -> InRoom | None:
        """Return the body in its place; None if the skeleton cannot move one, as the page says."""
        with self.context.database.reading() as db:
            joint_map, problems = joint_map_of(db, agreed.rig)
        if problems:
            return None
        try:
            body = OnBody(agreed, joint_map, reference_body(companion.stature), "flat")
        except RigError:
            return None
        return InRoom(body, Standing(companion.position_m, companion.heading_rad))
