"""A headset's WebSocket: sends through the journal, reconnects, follows the session."""

import asyncio
import contextlib
import logging
from collections.abc import Callable
from dataclasses import dataclass, field
from types import TracebackType

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake

from app.client.journal import Entry, Journal
from app.wire import StreamName
from app.wire.messages import (
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
    RefusedReport,
    Report,
    ReportBody,
    Resend,
    Welcome,
)

log = logging.getLogger(__name__)
RETRY_S = (0.1, 0.2, 0.5, 1.0, 2.0)
OPEN_TIMEOUT_S = 10.0


class TelemetryError(RuntimeError):
    """The server refused the connection for good; the message says why and what to do."""


@dataclass
class TelemetryClient:
    """One run (epoch) of a headset.

        async with TelemetryClient(url, token, name, monotonic_s) as client:
            await client.send_batch(stream, seq_end, message)
            await client.report(body)
            client.state            # newest state of the session
            await client.drained()  # everything is on the server's disk

    `url`: ws://HOST/api/vr/stream. `monotonic_s`: the client's own clock.
    """

    url: str
    token: str
    name: str
    monotonic_s: Callable[[], float]
    probe_every_s: float = 1.0
    journal: Journal = field(default_factory=Journal)
    welcome: Welcome | None = None
    state: HeadsetState | None = None
    flags: list[Flag] = field(default_factory=list)
    refusals: list[RefusedReport] = field(default_factory=list)
    reconnects: int = 0
    failure: Failure | None = None
    _socket: ClientConnection | None = None
    _keeper: asyncio.Task[None] | None = None
    _ready: asyncio.Event = field(default_factory=asyncio.Event)
    _changed: asyncio.Condition = field(default_factory=asyncio.Condition)
    _next_report: int = 0

    async def __aenter__(self) -> "TelemetryClient":
        """Connect; returns once the server has answered."""
        self._keeper = asyncio.create_task(self._keep_connected())
        ready = asyncio.create_task(self._ready.wait())
        await asyncio.wait({self._keeper, ready}, return_when=asyncio.FIRST_COMPLETED)
        ready.cancel()
        self._raise_failure()
        return self

    async def __aexit__(
        self,
        _type: type[BaseException] | None,
        _error: BaseException | None,
        _traceback: TracebackType | None,
    ) -> None:
        """Close; what is not acknowledged stays in the journal."""
        if self._keeper is not None:
            self._keeper.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._keeper

    @property
    def epoch(self) -> int:
        """The number the server gave to this run."""
        if self.welcome is None:
            raise TelemetryError("not connected yet")
        return self.welcome.epoch

    @property
    def connected(self) -> bool:
        """Whether the socket is open now."""
        return self._socket is not None

    async def send_batch(self, stream: StreamName, seq_end: int, message: bytes) -> None:
        """Journal and send a batch; waits while the journal is full."""
        await self._send(Entry(stream, self.epoch, seq_end, message))

    async def report(self, body: ReportBody) -> None:
        """Journal and send a report."""
        seq, self._next_report = self._next_report, self._next_report + 1
        text = Report(epoch=self.epoch, seq=seq, body=body).model_dump_json()
        await self._send(Entry(REPORT_STREAM, self.epoch, seq + 1, text))

    async def drained(self) -> None:
        """Wait until everything sent is acknowledged."""
        await self._wait_for(lambda: len(self.journal) == 0)

    async def _send(self, entry: Entry) -> None:
        self._raise_failure()
        if self.journal.is_full:
            await self._wait_for(lambda: not self.journal.is_full)
        self.journal.add(entry)
        if self._socket is not None:
            # A broken socket is noticed by the reader, which reconnects and sends the journal.
            with contextlib.suppress(ConnectionClosed):
                await self._socket.send(entry.message)

    async def _wait_for(self, condition: Callable[[], bool]) -> None:
        async with self._changed:
            await self._changed.wait_for(lambda: condition() or self.failure is not None)
        self._raise_failure()

    def _raise_failure(self) -> None:
        if self.failure is not None:
            raise TelemetryError(f"{self.failure.message}. {self.failure.remedy}")

    async def _keep_connected(self) -> None:
        attempt = 0
        while self.failure is None:
            try:
                async with connect(
                    self.url,
                    subprotocols=[SUBPROTOCOL, f"bearer.{self.token}"],  # type: ignore[list-item]
                    open_timeout=OPEN_TIMEOUT_S,
                    max_size=4 * 1024 * 1024,
                    compression=None,
                ) as socket:
                    await self._serve(socket)
                    attempt = 0
            except (OSError, ConnectionClosed, InvalidHandshake, TimeoutError) as error:
                log.info("connection lost: %s", error)
            finally:
                self._socket = None
            await asyncio.sleep(RETRY_S[min(attempt, len(RETRY_S) - 1)])
            attempt += 1
        await self._notify()

    async def _serve(self, socket: ClientConnection) -> None:
        """Greet, send what is left in the journal, then read until the socket closes."""
        epoch = None if self.welcome is None else self.welcome.epoch
        hello = Hello(protocol=PROTOCOL_VERSION, client=self.name, epoch=epoch)
        await socket.send(hello.model_dump_json())
        first = SERVER_MESSAGE.validate_json(await socket.recv())
        if isinstance(first, Failure):
            self.failure = first
            return
        if not isinstance(first, Welcome):
            raise TelemetryError(f"expected a welcome, got {first.type}")
        self.reconnects += self.welcome is not None
        self.welcome, self.state = first, first.state
        self.journal.acknowledge((p.stream, p.epoch, p.next_seq) for p in first.positions)
        await self._resend(socket)
        self._socket = socket
        self._ready.set()
        await self._notify()
        prober = asyncio.create_task(self._probe(socket))
        try:
            async for text in socket:
                await self._take(socket, text)
        finally:
            prober.cancel()

    async def _resend(self, socket: ClientConnection) -> None:
        for entry in self.journal:
            await socket.send(entry.message)

    async def _take(self, socket: ClientConnection, text: str | bytes) -> None:
        received_s = self.monotonic_s()
        message = SERVER_MESSAGE.validate_json(text)
        match message:
            case Ack():
                self.journal.acknowledge((p.stream, p.epoch, p.next_seq) for p in message.positions)
            case HeadsetState():
                self.state = message
            case Resend():
                await self._resend(socket)
            case Flag():
                self.flags.append(message)
            case RefusedReport():
                self.refusals.append(message)
            case Failure():
                self.failure = message
            case ProbeAnswer():
                await socket.send(_probed(message, received_s).model_dump_json())
            case _:
                log.debug("unexpected message %s", message.type)
        await self._notify()

    async def _notify(self) -> None:
        async with self._changed:
            self._changed.notify_all()

    async def _probe(self, socket: ClientConnection) -> None:
        while True:
            await socket.send(Probe(client_sent_s=self.monotonic_s()).model_dump_json())
            await asyncio.sleep(self.probe_every_s)


def _probed(answer: ProbeAnswer, received_s: float) -> Probed:
    return Probed(
        client_sent_s=answer.client_sent_s,
        server_received_ns=answer.server_received_ns,
        server_sent_ns=answer.server_sent_ns,
        client_received_s=received_s,
    )
