"""A headset's WebSocket client: sends through the journal, reconnects, follows the session."""

import asyncio
import contextlib
import logging
import time
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, field

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake

from app.client.journal import Entry, Journal
from app.errors import as_sentences
from app.wire import (
    PROTOCOL_VERSION,
    REPORT_STREAM,
    SERVER_MESSAGE,
    SUBPROTOCOL,
    Ack,
    Failure,
    Flag,
    HeadsetState,
    Hello,
    Probe,
    ProbeAnswer,
    Probed,
    Produced,
    RefusedReport,
    Report,
    ReportBody,
    Resend,
    StreamName,
    Welcome,
)

TIMEOUT_S = 2.0
log = logging.getLogger(__name__)
RETRY_S = (0.1, 0.2, 0.5, 1.0)
OPEN_TIMEOUT_S = 10.0


@dataclass
class Announcer:
    """Reports how much the client has produced, so that the server knows what is missing.

    It reports all streams when a connection opens, and once a second those that have changed.
    """

    socket: ClientConnection
    journal: Journal
    every_s: float = 1.0
    _reported: dict[tuple[str, int], int] = field(default_factory=dict)

    async def run(self) -> None:
        """Report periodically until cancelled."""
        while True:
            await self.report()
            await asyncio.sleep(self.every_s)

    async def report(self) -> None:
        """Report the streams that have changed since the last report."""
        news: dict[int, dict[str, int]] = defaultdict(dict)
        for (stream, epoch), count in self.journal.produced.items():
            if self._reported.get((stream, epoch)) != count:
                news[epoch][str(stream)] = count
                self._reported[stream, epoch] = count
        for epoch, streams in news.items():
            message = Produced.model_validate({"epoch": epoch, "streams": streams})
            await self.socket.send(message.model_dump_json())


@dataclass
class Prober:
    """Requests the server's clock periodically, and reports the raw readings of each exchange.

    `monotonic_s` is the client's own clock. If no answer comes within `timeout_s`, null is
    reported, never a number; a late answer is ignored.
    """

    socket: ClientConnection
    monotonic_s: Callable[[], float]
    every_s: float
    timeout_s: float = TIMEOUT_S
    _pending: dict[float, float] = field(default_factory=dict)

    async def run(self) -> None:
        """Send probes until cancelled."""
        while True:
            await self._give_up()
            client_sent_s = self.monotonic_s()
            self._pending[client_sent_s] = time.monotonic()
            await self.socket.send(Probe(client_sent_s=client_sent_s).model_dump_json())
            await asyncio.sleep(self.every_s)

    async def take(self, answer: ProbeAnswer, received_s: float) -> None:
        """Report the four raw times of an exchange."""
        if self._pending.pop(answer.client_sent_s, None) is None:
            return
        await self._send(
            Probed(
                client_sent_s=answer.client_sent_s,
                server_received_ns=answer.server_received_ns,
                server_sent_ns=answer.server_sent_ns,
                client_received_s=received_s,
            )
        )

    async def _give_up(self) -> None:
        before_s = time.monotonic() - self.timeout_s
        for client_sent_s in [sent for sent, at_s in self._pending.items() if at_s <= before_s]:
            del self._pending[client_sent_s]
            await self._send(
                Probed(
                    client_sent_s=client_sent_s,
                    server_received_ns=None,
                    server_sent_ns=None,
                    client_received_s=None,
                )
            )

    async def _send(self, reading: Probed) -> None:
        await self.socket.send(reading.model_dump_json())


class TelemetryError(RuntimeError):
    """The server refused the connection permanently; the message says why and what to do."""


@dataclass
class TelemetryClient:
    """A headset's telemetry connection during one run (epoch).

        async with TelemetryClient(url, token, name, monotonic_s) as client:
            await client.send_batch(stream, seq_end, message)
            await client.report(body)
            client.state            # newest state of the session
            await client.drained()  # everything is on the server's disk

    `url`: ws://HOST/api/vr/stream. `monotonic_s`: the client's own clock. `avatars`: the kinds of
    avatar that it can show. `fingers`: whether it sends the streams of fingers with
    every frame. `changes_avatar`: whether it can change a physics avatar while it runs.
    """

    url: str
    token: str
    name: str
    monotonic_s: Callable[[], float]
    avatars: tuple[str, ...] = ("delayed_copy",)
    fingers: bool = False
    changes_avatar: bool = False
    probe_every_s: float = 1.0
    journal: Journal = field(default_factory=Journal)
    welcome: Welcome | None = None
    state: HeadsetState | None = None
    flags: list[Flag] = field(default_factory=list)
    refusals: list[RefusedReport] = field(default_factory=list)
    reconnects: int = 0
    failure: Failure | None = None
    _socket: ClientConnection | None = None
    _announcer: Announcer | None = None
    _keeper: asyncio.Task[None] | None = None
    _ready: asyncio.Event = field(default_factory=asyncio.Event)
    _changed: asyncio.Condition = field(default_factory=asyncio.Condition)
    _next_report: int = 0
    _next_place: int = 0
    _added: asyncio.Event = field(default_factory=asyncio.Event)

    async def __aenter__(self) -> "TelemetryClient":
        """Connect; return once the server has answered."""
        self._keeper = asyncio.create_task(self._keep_connected())
        # Wake up everything that waits for an acknowledgement, since none will come.
        self._keeper.add_done_callback(lambda _: asyncio.ensure_future(self._notify()))
        ready = asyncio.create_task(self._ready.wait())
        await asyncio.wait({self._keeper, ready}, return_when=asyncio.FIRST_COMPLETED)
        ready.cancel()
        self._raise_failure()
        return self

    async def __aexit__(self, *_error: object) -> None:
        """Close the connection; unacknowledged messages stay in the journal."""
        if self._announcer is not None:
            with contextlib.suppress(ConnectionClosed):
                await self._announcer.report()
        if self._keeper is not None:
            self._keeper.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._keeper

    @property
    def epoch(self) -> int:
        """The epoch that the server assigned to this run."""
        if self.welcome is None:
            raise TelemetryError("not connected yet")
        return self.welcome.epoch

    @property
    def connected(self) -> bool:
        """Whether the socket is open now."""
        return self._socket is not None

    async def send_batch(self, stream: StreamName, seq_end: int, message: bytes) -> None:
        """Journal and send a batch, waiting while the journal is full."""
        await self._send(Entry(stream, self.epoch, seq_end, message))

    async def report(self, body: ReportBody) -> None:
        """Journal and send a report."""
        seq, self._next_report = self._next_report, self._next_report + 1
        text = Report(epoch=self.epoch, seq=seq, body=body).model_dump_json()
        await self._send(Entry(REPORT_STREAM, self.epoch, seq + 1, text))

    @property
    def settled(self) -> bool:
        """Whether every report is on the server's disk, so that its newest state reflects them."""
        return self.journal.stored_up_to(REPORT_STREAM, self.epoch) >= self._next_report

    async def at_most_waiting(self, messages: int) -> None:
        """Wait until at most this many messages await acknowledgement."""
        await self._wait_for(lambda: len(self.journal) <= messages)

    async def drained(self) -> None:
        """Wait until every message is acknowledged."""
        await self._wait_for(lambda: len(self.journal) == 0)

    async def _send(self, entry: Entry) -> None:
        self._raise_failure()
        if self.journal.is_full:
            await self._wait_for(lambda: not self.journal.is_full)
        self.journal.add(entry)
        self._added.set()
        # Let the sender run even if the producer never pauses.
        await asyncio.sleep(0)

    async def _wait_for(self, condition: Callable[[], bool]) -> None:
        async with self._changed:
            await self._changed.wait_for(lambda: condition() or self._over)
        self._raise_failure()

    @property
    def _over(self) -> bool:
        """Whether no further connection will be attempted."""
        return self.failure is not None or self._keeper is None or self._keeper.done()

    def _raise_failure(self) -> None:
        if self.failure is not None:
            raise TelemetryError(as_sentences(self.failure.message, self.failure.remedy))
        if self._keeper is not None and self._keeper.done() and not self._keeper.cancelled():
            raise TelemetryError("the connection's keeper has ended") from self._keeper.exception()

    async def _keep_connected(self) -> None:
        attempt = 0
        while self.failure is None:
            try:
                async with connect(
                    self.url,
                    subprotocols=[SUBPROTOCOL, f"bearer.{self.token}"],  # type: ignore[list-item]  # a token is a plain str
                    open_timeout=OPEN_TIMEOUT_S,
                    max_size=4 * 1024 * 1024,
                    compression=None,
                ) as socket:
                    await self._serve(socket)
            except (OSError, ConnectionClosed, InvalidHandshake, TimeoutError) as error:
                log.info("connection lost: %s", error)
            finally:
                # A connection that reached the welcome resets the retry delay.
                attempt = 0 if self._socket is not None else attempt
                self._socket = self._announcer = None
            await asyncio.sleep(RETRY_S[min(attempt, len(RETRY_S) - 1)])
            attempt += 1

    async def _serve(self, socket: ClientConnection) -> None:
        """Say hello, then send the journal and read messages until the socket closes."""
        epoch = None if self.welcome is None else self.welcome.epoch
        hello = Hello(
            protocol=PROTOCOL_VERSION,
            client=self.name,
            epoch=epoch,
            avatars=self.avatars,
            fingers=self.fingers,
            changes_avatar=self.changes_avatar,
        )
        # A server of an older version does not know the field.
        left_out = None if self.fingers else {"fingers"}
        await socket.send(hello.model_dump_json(exclude=left_out))
        first = SERVER_MESSAGE.validate_json(await socket.recv())
        if isinstance(first, Failure):
            self.failure = first
            return
        if not isinstance(first, Welcome):
            raise TelemetryError(f"expected a welcome, got {first.type}")
        self.reconnects += self.welcome is not None
        self.welcome, self.state = first, first.state
        self.journal.acknowledge((p.stream, p.epoch, p.next_seq) for p in first.positions)
        self._next_place = self.journal.first
        self._socket = socket
        self._ready.set()
        await self._notify()
        prober = Prober(socket, self.monotonic_s, self.probe_every_s)
        self._announcer = Announcer(socket, self.journal)
        tasks = [
            asyncio.create_task(work)
            for work in (prober.run(), self._announcer.run(), self._send_journal(socket))
        ]
        try:
            async for text in socket:
                await self._take(prober, text)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    async def _send_journal(self, socket: ClientConnection) -> None:
        """Send journaled messages; as their only sender it keeps them in order, without gaps.

        A broken socket ends it; the reader notices that, and the next connection starts with the
        oldest message.
        """
        while True:
            self._added.clear()
            self._next_place = max(self._next_place, self.journal.first)
            while (entry := self.journal.at(self._next_place)) is not None:
                self._next_place += 1
                await socket.send(entry.message)
                self._next_place = max(self._next_place, self.journal.first)
            await self._added.wait()

    async def _take(self, prober: Prober, text: str | bytes) -> None:
        received_s = self.monotonic_s()
        message = SERVER_MESSAGE.validate_json(text)
        match message:
            case Ack():
                self.journal.acknowledge((p.stream, p.epoch, p.next_seq) for p in message.positions)
            case HeadsetState():
                self.state = message
            case Resend():
                self._next_place = self.journal.first
                self._added.set()
            case Flag():
                self.flags.append(message)
            case RefusedReport():
                self.refusals.append(message)
            case Failure():
                self.failure = message
            case ProbeAnswer():
                await prober.take(message, received_s)
            case _:
                log.debug("unexpected message %s", message.type)
        await self._notify()

    async def _notify(self) -> None:
        async with self._changed:
            self._changed.notify_all()
