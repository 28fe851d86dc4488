"""The interface of a headset in the load, and its implementation by the product's real client."""

import asyncio
import time
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

from app.client.journal import Entry, Journal
from app.client.telemetry import TelemetryClient
from app.wire import StreamName
from app.wire.messages import HeadsetState, ReportBody
from tests.benchmarks.load.record import Record


class Headset(Protocol):
    """A connected headset that records every message handed to it for sending."""

    @property
    def epoch(self) -> int:
        """Return the epoch, the number of this run."""

    @property
    def state(self) -> HeadsetState | None:
        """Return the newest state of the session."""

    async def hand(self, stream: StreamName, seq_end: int, message: bytes) -> None:
        """Send a batch of frames."""

    async def report(self, body: ReportBody) -> None:
        """Send a report."""

    async def close(self) -> None:
        """Close the connection."""


@dataclass
class RecordedJournal(Journal):
    """The client's own journal, with a record of added and acknowledged messages."""

    record: Record | None = None

    def add(self, entry: Entry) -> None:
        """Add a message and record it."""
        assert self.record is not None
        self.record.epoch = entry.epoch
        self.record.hand(entry.stream, entry.seq_end)
        super().add(entry)

    def acknowledge(self, positions: Iterable[tuple[str, int, int]]) -> None:
        """Remove acknowledged messages and record them."""
        known = list(positions)
        super().acknowledge(known)
        if self.record is not None:
            self.record.acknowledge(known)


@dataclass
class RealHeadset:
    """The product's own client; use `open` to create one."""

    client: TelemetryClient

    @classmethod
    async def open(cls, url: str, token: str, record: Record) -> "RealHeadset":
        """Connect a client whose journal writes the record."""
        began_s = time.monotonic()
        client = TelemetryClient(
            url,
            token,
            "load",
            lambda: time.monotonic() - began_s,
            journal=RecordedJournal(record=record),
        )
        await client.__aenter__()
        record.epoch = client.epoch
        return cls(client)

    @property
    def epoch(self) -> int:
        """Return the epoch, the number of this run."""
        return self.client.epoch

    @property
    def state(self) -> HeadsetState | None:
        """Return the newest state of the session."""
        return self.client.state

    async def hand(self, stream: StreamName, seq_end: int, message: bytes) -> None:
        """Send a batch through the journal."""
        await self.client.send_batch(stream, seq_end, message)

    async def report(self, body: ReportBody) -> None:
        """Send a report through the journal."""
        await self.client.report(body)

    async def close(self) -> None:
        """Close the connection."""
        await self.client.__aexit__(None, None, None)
        await asyncio.sleep(0)
