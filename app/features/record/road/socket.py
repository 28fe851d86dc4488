"""The socket of a headset on the road: the participant's places in, everybody else's out."""

import asyncio
import time
from contextlib import suppress
from dataclasses import asdict, dataclass, field

from pydantic import ValidationError
from starlette.websockets import WebSocket

from app.errors import InvalidInput
from app.features.record.headset import next_message, until_one_ends
from app.features.record.road.scene import RoadScene
from app.features.record.road.service import Roads
from app.features.record.telemetry import TelemetryWriter
from app.platform.context import AppContext
from app.platform.tokens import device_of_token
from app.science.cosimulation import State
from app.wire import (
    FROM_ROAD_CLIENT,
    Message,
    RoadActor,
    RoadActors,
    RoadClock,
    RoadEnd,
    RoadEnded,
    RoadHello,
    RoadMessage,
    RoadPlaces,
    RoadWelcome,
)

HELLO_S = 10.0
PAIRING_CHECKED_S = 10.0


@dataclass(eq=False)
class RoadSocket:
    """An open socket of a session's headset during a phase on the road."""

    socket: WebSocket
    context: AppContext
    _writer: TelemetryWriter
    session_id: str
    token: str
    _loop: asyncio.AbstractEventLoop = field(default_factory=asyncio.get_running_loop)
    _news: asyncio.Event = field(default_factory=asyncio.Event)
    _newest: tuple[int, tuple[State, ...]] | None = None
    _ended: str | None = None

    async def run(self) -> None:
        """Serve the socket until it closes or the scene has ended."""
        async with asyncio.timeout(HELLO_S):
            hello = await self._next()
        if not isinstance(hello, RoadHello):
            raise InvalidInput("the first message is no hello", remedy="Send hello first.")
        scene = await asyncio.to_thread(self.context.part(Roads).join, self.session_id, hello)
        plan, participant = scene.plan, scene.participant
        await self._write(
            RoadWelcome(
                run=plan.id,
                phase_id=plan.phase_id,
                begins_at_s=plan.begins_at_s,
                step_s=participant.step_s,
                next_step=participant.next_step,
            )
        )
        scene.on_end = self._end
        participant.attach(self._take)
        if scene.is_over:
            self._end(scene.problem)
        try:
            await until_one_ends(
                self._read(scene), self._send(plan.begins_at_s, participant.step_s)
            )
        finally:
            participant.detach(self._take)

    async def _next(self) -> RoadMessage:
        message = await next_message(self.socket)
        try:
            return FROM_ROAD_CLIENT.validate_json(message)
        except ValidationError as error:
            first = error.errors(include_url=False, include_input=False)[0]
            place = ".".join(map(str, first["loc"]))[:100]
            raise InvalidInput(
                f"message not understood: {first['msg'][:300]} at {place}",
                value=str(message[:200]),
                remedy="See docs/protocol.md for the messages.",
            ) from error

    async def _read(self, scene: RoadScene) -> None:
        participant = scene.participant
        while True:
            match await self._next():
                case RoadPlaces(first_step=first_step, places=places):
                    try:
                        participant.put(first_step, places)
                    except ValueError as error:
                        raise InvalidInput(
                            str(error), value=first_step, remedy="Send every step, in order."
                        ) from error
                case RoadClock(running=running):
                    participant.run_clock(is_running=running)
                case RoadEnd():
                    # The scene says when it has ended; then this socket closes.
                    participant.end()
                case RoadHello():
                    raise InvalidInput("hello came twice", remedy="Open a new connection.")

    async def _send(self, begins_at_s: float, step_s: float) -> None:
        """Send the newest states, and that the scene has ended, after which nothing comes."""
        checked_s = time.monotonic()
        while True:
            with suppress(TimeoutError):
                async with asyncio.timeout(PAIRING_CHECKED_S):
                    await self._news.wait()
            if time.monotonic() - checked_s >= PAIRING_CHECKED_S:
                await asyncio.to_thread(self._require_pairing)
                checked_s = time.monotonic()
            self._news.clear()
            newest, self._newest = self._newest, None
            if newest is not None:
                step, others = newest
                active_s = round(begins_at_s + step * step_s, 6)
                actors = tuple(_actor(one) for one in others)
                await self._write(RoadActors(step=step, active_s=active_s, actors=actors))
            if self._ended is not None:
                await self._write(RoadEnded(problem=self._ended))
                return

    def _take(self, step: int, others: tuple[State, ...]) -> None:
        """Take the newest states, in the scene's thread."""
        self._newest = (step, others)
        self._wake()

    def _end(self, problem: str) -> None:
        self._ended = problem
        self._wake()

    def _wake(self) -> None:
        try:
            self._loop.call_soon_threadsafe(self._news.set)
        except RuntimeError:  # the event loop has closed, so there is no socket left
            return

    def _require_pairing(self) -> None:
        with self.context.database.reading() as db:
            device_of_token(db, self.token, "headset")

    async def _write(self, message: Message) -> None:
        await self.socket.send_text(message.model_dump_json())


def _actor(state: State) -> RoadActor:
    values = asdict(state)
    del values["time_s"]
    return RoadActor(**values)
