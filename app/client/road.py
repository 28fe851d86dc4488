"""A headset's client of the study's road: says where the participant is, hears where others are."""

import asyncio
import logging
from collections.abc import Sequence

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake

from app.wire import (
    FROM_ROAD_SERVER,
    SUBPROTOCOL,
    FloorPlace,
    Message,
    RoadActors,
    RoadClock,
    RoadEnd,
    RoadEnded,
    RoadHello,
    RoadPlaces,
    RoadWelcome,
)

log = logging.getLogger(__name__)
RETRY_S = 0.5
OPEN_TIMEOUT_S = 10.0
MOST_IN_MESSAGE = 256
LONGEST_END_S = 60.0
"""How long a busy server may take to measure and store a scene that has ended."""


class RoadClient:
    """The road of one phase, until `end`; the connection is opened again whenever it is lost.

    Args:
        url: of the road's socket.
        token: of the paired headset.
        phase_id: the phase.
        active_s: its active time now.
        place: where the participant stands.
    """

    def __init__(
        self, url: str, token: str, phase_id: int, active_s: float, place: FloorPlace
    ) -> None:
        self.actors: RoadActors | None = None
        self.ended: RoadEnded | None = None
        self._url, self._token = url, token
        self._phase_id, self._active_s, self._place = phase_id, active_s, place
        self._welcome: RoadWelcome | None = None
        self._places: list[FloorPlace] = []
        self._running = False
        self._is_ending = False
        self._news = asyncio.Condition()
        self._due = asyncio.Event()
        self._keeper = asyncio.create_task(self._keep_connected())

    @property
    def run(self) -> RoadWelcome | None:
        """The run as the server began it; None before."""
        return self._welcome

    @property
    def problem(self) -> str:
        """Why the scene broke off; empty if it did not."""
        return "" if self.ended is None else self.ended.problem

    @property
    def has_traffic(self) -> bool:
        """Whether the traffic has warmed up and goes on."""
        return self.actors is not None and self.ended is None

    @property
    def said(self) -> int:
        """How many steps were said so far."""
        return len(self._places)

    def say(self, places: Sequence[FloorPlace], *, running: bool) -> None:
        """Say where the participant was at the next steps, and whether the phase's clock runs."""
        if not places and running == self._running:
            return
        self._places.extend(places)
        self._running = running
        self._due.set()

    async def caught_up(self, timeout_s: float) -> bool:
        """Wait until the others are known at the last step that was said; False if it takes long.

        Before any step it waits until the traffic has warmed up.

        A rehearsal faster than real time waits, so that the participant sees what is there.
        """

        def is_there() -> bool:
            known = -1 if self.actors is None else self.actors.step
            return self.ended is not None or known >= max(0, self.said - 1)

        try:
            async with asyncio.timeout(timeout_s), self._news:
                await self._news.wait_for(is_there)
        except TimeoutError:
            return False
        return True

    async def end(self, timeout_s: float = LONGEST_END_S) -> None:
        """Say that the phase is over, and wait until the server has ended the scene."""
        self._is_ending = True
        self._due.set()
        try:
            async with asyncio.timeout(timeout_s), self._news:
                await self._news.wait_for(lambda: self.ended is not None)
        except TimeoutError:
            log.warning("the road of phase %d did not end in time", self._phase_id)
        self._keeper.cancel()
        await asyncio.gather(self._keeper, return_exceptions=True)

    async def _keep_connected(self) -> None:
        while self.ended is None:
            try:
                async with connect(
                    self._url,
                    subprotocols=[SUBPROTOCOL, f"bearer.{self._token}"],  # type: ignore[list-item]  # a token is a plain str
                    open_timeout=OPEN_TIMEOUT_S,
                    compression=None,
                ) as socket:
                    await self._serve(socket)
            except (OSError, ConnectionClosed, InvalidHandshake, TimeoutError) as error:
                log.info("the road's connection is lost: %s", error)
            if self.ended is None:
                await asyncio.sleep(RETRY_S)

    async def _serve(self, socket: ClientConnection) -> None:
        known = None if self._welcome is None else self._welcome.run
        active_s = self._active_s
        await self._send(
            socket,
            RoadHello(phase_id=self._phase_id, active_s=active_s, place=self._place, run=known),
        )
        welcome = FROM_ROAD_SERVER.validate_json(await socket.recv())
        if not isinstance(welcome, RoadWelcome):
            raise ConnectionClosed(None, None)
        async with self._news:
            self._welcome = welcome
            self._news.notify_all()
        sending = asyncio.create_task(self._say_all(socket, welcome.next_step))
        try:
            while self.ended is None:
                message = FROM_ROAD_SERVER.validate_json(await socket.recv())
                async with self._news:
                    if isinstance(message, RoadActors):
                        self.actors = message
                    elif isinstance(message, RoadEnded):
                        self.ended = message
                    self._news.notify_all()
        finally:
            sending.cancel()
            await asyncio.gather(sending, return_exceptions=True)

    async def _say_all(self, socket: ClientConnection, said: int) -> None:
        """Send what has not been sent on this connection, again and again."""
        was_running = False
        self._due.set()
        while True:
            await self._due.wait()
            self._due.clear()
            if self._running != was_running:
                was_running = self._running
                await self._send(socket, RoadClock(running=was_running))
            while said < len(self._places):
                places = tuple(self._places[said : said + MOST_IN_MESSAGE])
                await self._send(socket, RoadPlaces(first_step=said, places=places))
                said += len(places)
            if self._is_ending:
                await self._send(socket, RoadEnd())

    async def _send(self, socket: ClientConnection, message: Message) -> None:
        await socket.send(message.model_dump_json())
