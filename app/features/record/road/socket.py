"""The socket of a headset on the road: the participant's places in, everybody else's out."""

import asyncio
from dataclasses import asdict, dataclass

from anyio.to_thread import run_sync

from app.errors import InvalidInput, TakenOver
from app.features.record.headset import FurtherSocket, next_of, until_one_ends
from app.features.record.road.scene import RoadScene
from app.features.record.road.service import Roads, Wake
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
        roads, wake = self.context.part(Roads), self._wake
        # In threads of their own, because a join waits for the end of the scene before.
        limiter = roads.joining(self.session_id)
        scene = await run_sync(roads.join, self.session_id, hello, wake, limiter=limiter)
        try:
            await self._serve(roads, wake, scene)
        finally:
            scene.participant.detach(self._take)
            roads.detach(self.session_id, wake)

    async def _serve(self, roads: Roads, wake: Wake, scene: RoadScene) -> None:
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
        self._require_newest(roads, wake)
        scene.on_end = self._end
        participant.attach(self._take)
        if scene.is_over:
            self._end(scene.problem)
        await until_one_ends(self._read(scene), self._send(roads, wake, scene))

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

    async def _send(self, roads: Roads, wake: Wake, scene: RoadScene) -> None:
        """Send the newest states, and that the scene has ended, after which nothing comes."""
        begins_at_s, step_s = scene.plan.begins_at_s, scene.participant.step_s
        while True:
            await self._wait_for_news()
            self._require_newest(roads, wake)
            newest, self._newest = self._newest, None
            if newest is not None:
                step, others = newest
                active_s = round(begins_at_s + step * step_s, 6)
                actors = tuple(_actor(one) for one in others)
                await self._write(RoadActors(step=step, active_s=active_s, actors=actors))
            if self._ended is not None:
                if scene.refusal is not None:
                    raise scene.refusal
                await self._write(RoadEnded(problem=self._ended))
                return

    def _require_newest(self, roads: Roads, wake: Wake) -> None:
        if not roads.is_attached(self.session_id, wake):
            raise TakenOver(
                "another page of this headset is on the road now",
                remedy="Continue there, and close this page; to continue here, reload it.",
            )

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
