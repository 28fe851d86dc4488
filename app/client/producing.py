"""Telling the server how far the client itself has come, so that it knows what it does not have."""

import asyncio
from collections import defaultdict
from dataclasses import dataclass, field

from websockets.asyncio.client import ClientConnection

from app.client.journal import Journal
from app.wire.messages import Produced


@dataclass
class Announcer:
    """Tells of everything once a connection is open, then once a second of what has changed."""

    socket: ClientConnection
    journal: Journal
    every_s: float = 1.0
    _told: dict[tuple[str, int], int] = field(default_factory=dict)

    async def run(self) -> None:
        """Tell until cancelled."""
        while True:
            await self.tell()
            await asyncio.sleep(self.every_s)

    async def tell(self) -> None:
        """Tell of what has changed since the last time."""
        news: dict[int, dict[str, int]] = defaultdict(dict)
        for (stream, epoch), count in self.journal.produced.items():
            if self._told.get((stream, epoch)) != count:
                news[epoch][str(stream)] = count
                self._told[stream, epoch] = count
        for epoch, streams in news.items():
            message = Produced.model_validate({"epoch": epoch, "streams": streams})
            await self.socket.send(message.model_dump_json())
