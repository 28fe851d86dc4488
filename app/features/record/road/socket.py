"""The socket of a headset on the road: the participant's places in, everybody else's out."""

import asyncio
from dataclasses import asdict, dataclass

from app.errors import InvalidInput
from app.features.record.headset import FurtherSocket, next_of, until_one_ends
from app.features.record.road.scene import RoadScene
from app.features.record.road.service import Roads
from app.science.cosimulation import State
from app.wire import (
    FROM_ROAD_CLIENT,
    RoadActor,
    RoadActors,
    RoadClock,
    RoadEnd,
    RoadEnded,
    RoadHello,
    RoadPlaces,
    RoadWelcome,
)

HELLO_S = 10.0


@dataclass(eq=False)
class RoadSocket(FurtherSocket):
    """An open socket of a session's headset during a phase on the road."""

    _newest: tuple[int, tuple[State, ...]] | None = None
    _ended: str | None = None

    async def run(self) -> None:
        """Serve the socket until it closes or the scene has ended."""
        async with asyncio.timeout(HELLO_S):
            hello = await next_of(self.socket, FROM_ROAD_CLIENT)
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

    async def _read(self, scene: RoadScene) -> None:
        participant = scene.participant
        while True:
            match await next_of(self.socket, FROM_ROAD_CLIENT):
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
        while True:
            await self._wait_for_news()
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


def _actor(state: State) -> RoadActor:
    values = asdict(state)
    del values["time_s"]
    return RoadActor(**values)
