"""The socket on which a page watches a performer on a body: the newest pose, and no older one.

First and whenever something changes come JSON messages (`BodySetup`, `BodyState`). Then poses,
little-endian binary:

    offset  type     field
    0       4 bytes  magic "RLB1"
    4       u16      number of values, n
    6       u16      bones of the performer whose pose was lost or not sent
    8       u32      number of the performer's frame, from 1
    12      u32      frames that were left out for this page, because newer ones followed
    16      f64      time by the source's own clock, s; NaN if it sends none
    24      f64      the same on the server's monotonic clock
    32      f32      from the packet's arrival to here, s
    36      f32[n]   the body's hips x, y, z (m, world), then its local rotations w, x, y, z

The page answers each pose with any message. At most `ahead` poses are under way unanswered, so that
nothing piles up for a slow page, however much the network and the browser would keep.
"""

import asyncio
import struct
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np
from starlette.websockets import WebSocket, WebSocketDisconnect

from app.errors import InvalidInput, NotSignedIn, ReembodyError
from app.features.movement.captures import CaptureQueue, mapped_capture
from app.features.movement.performers.assembly import BodyFrame
from app.features.movement.performers.on_body import Body, GroundKey, OnBody, reference_body
from app.features.movement.performers.performer import Agreed, Performer, PerformerName
from app.features.movement.performers.schemas import BodySetup, BodyState
from app.features.movement.performers.service import Performers
from app.features.movement.performers.views import body_state, joint_map_of
from app.features.movement.performers.worker_tasks import skeleton_of
from app.platform.context import AppContext
from app.platform.dependencies import authorised_caller
from app.science.retargeting import AvatarError, named_stature_m
from app.science.rig import RigError

MAGIC = b"RLB1"
HEADER = struct.Struct("<4sHHIIddf")
MOST_AHEAD = 16
RECHECK_S = 5.0
"""How often access is checked, so that a login that has ended is noticed."""
LOOKED_S = 0.5
"""How often a page without news is told whether the performer is silent."""
CLOSE_NOT_SIGNED_IN = 4401
CLOSE_REFUSED = 4403
_WRAP = 2**32


@dataclass(frozen=True)
class Watched:
    """What is watched: a performer on a body over a ground.

    `avatar` is a stature, such as "165cm", or the id of a capture, whose skeleton is the body.
    """

    name: PerformerName
    avatar: str
    ground: GroundKey
    ahead: int


async def serve_watcher(socket: WebSocket, context: AppContext, watched: Watched) -> None:
    """Serve a page's socket until either side closes it, or the page loses access."""
    await socket.accept()
    try:
        await _Watcher(socket, context, watched).run()
    except (WebSocketDisconnect, RuntimeError):
        return
    except NotSignedIn:
        await socket.close(CLOSE_NOT_SIGNED_IN)
    except ReembodyError as error:
        refused = BodyState(state="refused", problems=[error.message])
        with suppress(RuntimeError, WebSocketDisconnect):  # the page may have gone meanwhile
            await socket.send_text(refused.model_dump_json())
            await socket.close(CLOSE_REFUSED)


@dataclass(eq=False)
class _Watcher:
    """The connection of one page."""

    socket: WebSocket
    context: AppContext
    watched: Watched
    _loop: asyncio.AbstractEventLoop = field(default_factory=asyncio.get_running_loop)
    _news: asyncio.Event = field(default_factory=asyncio.Event)
    _is_woken: bool = False
    _undrawn: int = 0
    _drawn_on: Body | None = None
    _body: OnBody | None = None
    _for: Agreed | None = None
    _problems: tuple[str, ...] = ()
    _state: BodyState | None = None
    _sent: BodyFrame | None = None
    _skipped: int = 0
    _checked_s: float = float("-inf")

    async def run(self) -> None:
        performers = self.context.part(Performers)
        await self._check_access()
        wake = self._wake
        performers.watch(self.watched.name, wake)
        sending = asyncio.create_task(self._send(performers))
        receiving = asyncio.create_task(self._receive())
        try:
            ended, _ = await asyncio.wait({sending, receiving}, return_when="FIRST_COMPLETED")
            await ended.pop()
        finally:
            performers.unwatch(self.watched.name, wake)
            sending.cancel()
            receiving.cancel()
            await asyncio.gather(sending, receiving, return_exceptions=True)

    def _wake(self) -> None:
        """Look for news soon; called from any thread, and often."""
        if self._is_woken:
            return
        self._is_woken = True
        try:
            self._loop.call_soon_threadsafe(self._news.set)
        except RuntimeError:  # the event loop has closed, so there is no socket left
            return

    async def _receive(self) -> None:
        """Note what was drawn, until the page closes the socket."""
        async for _ in self.socket.iter_text():
            is_waited_for = self._undrawn >= self.watched.ahead
            self._undrawn = max(0, self._undrawn - 1)
            if is_waited_for:
                self._news.set()

    async def _send(self, performers: Performers) -> None:
        while True:
            if self._loop.time() - self._checked_s >= RECHECK_S:
                await self._check_access()
            performer, others = performers.used(self.watched.name)
            await self._prepare(performer)
            await self._tell(performer, others, performers.now_s())
            if performer is not None and self._undrawn < self.watched.ahead:
                await self._show(performer, performers)
            try:
                async with asyncio.timeout(LOOKED_S):
                    await self._news.wait()
            except TimeoutError:
                pass
            self._is_woken = False
            self._news.clear()

    async def _check_access(self) -> None:
        self._checked_s = self._loop.time()
        await asyncio.to_thread(authorised_caller, self.socket, self.context, "WEBSOCKET")

    async def _prepare(self, performer: Performer | None) -> None:
        """Make the body anew, in a thread, if the performer is another or was agreed with."""
        agreed = None if performer is None else performer.agreed
        if agreed is None or agreed is self._for:
            return
        if self._drawn_on is None:
            self._drawn_on = await self._chosen()
        self._body, self._problems, setup = await asyncio.to_thread(
            self._made, agreed, self._drawn_on
        )
        self._for = agreed
        if setup is not None:
            await self.socket.send_text(setup.model_dump_json())

    async def _chosen(self) -> Body:
        """Return the body that is moved; raises ReembodyError if there is none."""
        avatar = self.watched.avatar
        if named_stature_m(avatar) is not None:
            try:
                return reference_body(avatar)
            except AvatarError as error:
                raise InvalidInput(str(error), value=avatar) from None
        mapped = await asyncio.to_thread(mapped_capture, self.context, avatar)
        rig = await self.context.part(CaptureQueue).run(skeleton_of, mapped)
        return Body(rig, dict(mapped.joint_map), None)

    def _made(
        self, agreed: Agreed, body: Body
    ) -> tuple[OnBody | None, tuple[str, ...], BodySetup | None]:
        with self.context.database.reading() as db:
            joint_map, problems = joint_map_of(db, agreed.rig)
        if problems:
            return None, problems, None
        try:
            on_body = OnBody(agreed, joint_map, body, self.watched.ground)
        except RigError as error:
            return None, (str(error),), None
        line, rig = on_body.line, body.rig
        return (
            on_body,
            (),
            BodySetup(
                stature_m=body.stature_m,
                joint_map=dict(body.joint_map),
                joints=rig.names,
                parents=rig.parents,
                offsets_m=[(float(x), float(y), float(z)) for x, y, z in rig.offsets_m],
                ground_start_m=None if line is None else line.start_m,
                uphill=None if line is None else line.uphill,
                profile_m=[] if line is None else list(line.profile_m),
                scale=on_body.scale,
                unmapped=list(on_body.unmapped),
            ),
        )

    async def _tell(
        self, performer: Performer | None, others: tuple[str, ...], now_s: float
    ) -> None:
        """Send the state, if it is another one."""
        state = body_state(performer, others, self._problems, now_s)
        if state != self._state:
            self._state = state
            await self.socket.send_text(state.model_dump_json())

    async def _show(self, performer: Performer, performers: Performers) -> None:
        frame, body = performer.newest, self._body
        if frame is None or body is None or frame is self._sent:
            return
        if frame.skeleton is not body.agreed.skeleton:
            return  # it has just become another skeleton; the body follows at the next turn
        before = self._sent
        if before is not None and frame.skeleton is before.skeleton:
            self._skipped += frame.number - before.number - 1
        self._sent = frame
        values = body.values(frame).astype("<f4")
        header = HEADER.pack(
            MAGIC,
            len(values),
            int(np.count_nonzero(~frame.observed)),
            frame.number % _WRAP,
            self._skipped % _WRAP,
            float("nan") if frame.source_s is None else frame.source_s,
            frame.mapped_s,
            performers.now_s() - frame.arrival_s,
        )
        self._undrawn += 1
        await self.socket.send_bytes(header + values.tobytes())
