"""The socket on which a self-test sends batches: stored, acknowledged, and not kept.

A batch takes the way of telemetry: the socket, the writer's queue, the commit that it shares with
all running sessions, and the acknowledgement after it.
"""

import asyncio
import weakref
from dataclasses import dataclass, field

from starlette.websockets import WebSocket, WebSocketState

from app.errors import Conflict, InvalidInput, NotDurable, ReembodyError, TooLarge
from app.features.record.headset import next_message
from app.features.record.self_tests.schemas import RunningTest
from app.features.record.self_tests.service import require_no_phase
from app.features.record.telemetry import (
    NO_SESSION,
    Arrival,
    Outcome,
    TelemetryWriter,
    TrialContent,
    TrialEnd,
)
from app.models import new_id
from app.platform.context import AppContext
from app.platform.hub import Hub, Subscription
from app.platform.tokens import device_of_token
from app.wire import Ack, BatchHeader, decode_batch

MAX_IN_FLIGHT = 64
"""As on the socket of a session."""
MAX_BATCHES = 20_000
MAX_BYTES = 128 * 2**20
MAX_DURATION_S = 600.0
BYTES_PER_S = 512 * 2**10
"""Several times what a visit with fingers sends, and little beside what the disk takes."""
BURST_BYTES = 2 * 2**20
"""What may come at once, such as after a network that stood still for some seconds."""
EPOCH = 1
PLANNED_S = 120.0
"""How long the headset's page measures, from its first batch on (`vr/selftest/plan.ts`)."""
_running: weakref.WeakKeyDictionary[Hub, dict[str, "StorageTrial"]] = weakref.WeakKeyDictionary()
"""The running trial of each session, whose only headset makes it."""


def running_test(context: AppContext, session_id: str) -> RunningTest | None:
    """Return how far the self-test of a session's headset is; None if none runs."""
    trial = _running.get(context.hub, {}).get(session_id)
    return None if trial is None else trial.progress()


@dataclass
class Allowance:
    """The bytes that may still come: refilled at `BYTES_PER_S`, up to `BURST_BYTES`."""

    left: float = BURST_BYTES
    at_s: float | None = None

    def take(self, size_bytes: int, now_s: float) -> bool:
        """Take a message's bytes; returns False, and takes nothing, if there are not enough."""
        if self.at_s is not None:
            self.left = min(BURST_BYTES, self.left + BYTES_PER_S * (now_s - self.at_s))
        self.at_s = now_s
        if size_bytes > self.left:
            return False
        self.left -= size_bytes
        return True


@dataclass(eq=False)
class StorageTrial:
    """An open socket of a self-test; `deliver` and `fail` are safe from the writer's thread."""

    socket: WebSocket
    context: AppContext
    writer: TelemetryWriter
    session_id: str
    token: str
    _trial_id: str = field(default_factory=new_id)
    _next_seqs: dict[str, int] = field(default_factory=dict)
    _batches: int = 0
    _bytes: int = 0
    _began_s: float | None = None
    _allowance: Allowance = field(default_factory=Allowance)
    _loop: asyncio.AbstractEventLoop = field(default_factory=asyncio.get_running_loop)
    _outbox: asyncio.Queue[Ack | ReembodyError] = field(default_factory=asyncio.Queue)
    _in_flight: asyncio.Semaphore = field(default_factory=lambda: asyncio.Semaphore(MAX_IN_FLIGHT))

    def deliver(self, outcome: Outcome) -> None:
        """Handle batches that are now on disk; called by the writer."""
        self._call(outcome)

    def fail(self, error: Exception) -> None:
        """Tell the headset that its batches cannot be stored; called by the writer."""
        self._call(NotDurable(str(error)[:300], remedy="Start the self-test again."))

    def refuse(self, error: ReembodyError) -> None:
        """Close the socket with an error; called in the event loop."""
        self._outbox.put_nowait(error)

    def progress(self) -> RunningTest:
        """Return how far the test is, from any thread."""
        began_s = self._began_s
        if began_s is None:
            return RunningTest(left_s=None)
        return RunningTest(left_s=max(0.0, began_s + PLANNED_S - self._now_s()))

    def _now_s(self) -> float:
        return self.context.clock.monotonic_ns() / 1e9

    async def run(self) -> None:
        """Serve the socket until it closes; raises the error with which it has to close."""
        with self.context.hub.subscribe(self.session_id) as subscription:
            # After subscribing, so that no end of the pairing is missed in between.
            await asyncio.to_thread(self._require_allowed)
            self._replace_older()
            self.context.hub.publish(self.session_id, "session")
            tasks = [
                asyncio.create_task(self._read()),
                asyncio.create_task(self._send()),
                asyncio.create_task(self._watch(subscription)),
            ]
            try:
                done, _ = await asyncio.wait(
                    tasks, timeout=MAX_DURATION_S, return_when=asyncio.FIRST_COMPLETED
                )
                for task in done:
                    task.result()
                if not done:
                    raise TooLarge(
                        "the self-test sends for too long",
                        valid=f"up to {MAX_DURATION_S:.0f} s",
                        remedy="Send the report, and start another test.",
                    )
            finally:
                running = _running.get(self.context.hub, {})
                if running.get(self.session_id) is self:
                    del running[self.session_id]
                    self.context.hub.publish(self.session_id, "session")
                for task in tasks:
                    task.cancel()
                # Before waiting, which a server that stops would cancel: a cancelled task submits
                # no more batches.
                self.writer.submit(Arrival(NO_SESSION, self, TrialEnd(self._trial_id)))
                await asyncio.gather(*tasks, return_exceptions=True)

    def _replace_older(self) -> None:
        """End an older test of this pairing: it is told why, and only this one sends."""
        running = _running.setdefault(self.context.hub, {})
        older = running.get(self.session_id)
        running[self.session_id] = self
        if older is not None:
            older.refuse(
                Conflict(
                    "a newer self-test of this headset has replaced this one",
                    remedy="Go on with the newer one; a headset makes one test at a time.",
                )
            )

    async def _read(self) -> None:
        while True:
            message = await next_message(self.socket)
            if isinstance(message, str):
                raise InvalidInput(
                    "this socket takes batches only",
                    value=message[:200],
                    remedy="Send everything else on the session's socket.",
                )
            batch = decode_batch(message)
            self._admit(batch.header, len(message))
            await self._in_flight.acquire()
            content = TrialContent(self._trial_id, batch.header, message)
            self.writer.submit(Arrival(NO_SESSION, self, content))

    def _admit(self, header: BatchHeader, size_bytes: int) -> None:
        stream = str(header.stream)
        expected = (EPOCH, 0, self._next_seqs.get(stream, 0))
        if (header.epoch, header.phase_id, header.seq_first) != expected:
            raise InvalidInput(
                f"epoch, phase_id or seq of a batch of the stream {stream} is not the expected one",
                value=[header.epoch, header.phase_id, header.seq_first],
                valid=list(expected),
                remedy="Use epoch 1 and phase 0, and seqs from 0 without gaps in every stream.",
            )
        if self._began_s is None:
            self._began_s = self._now_s()
            self.context.hub.publish(self.session_id, "session")
        self._next_seqs[stream] = header.seq_end
        self._batches += 1
        self._bytes += size_bytes
        if not self._allowance.take(size_bytes, self._now_s()):
            raise TooLarge(
                "the self-test sends faster than a session does",
                value={"bytes": size_bytes, "bytes_left": int(self._allowance.left)},
                valid={"bytes_per_s": BYTES_PER_S, "bytes_at_once": BURST_BYTES},
                remedy="Send some 20 batches a second, each about as soon as its frames are made.",
            )
        if self._batches > MAX_BATCHES or self._bytes > MAX_BYTES:
            raise TooLarge(
                "the self-test sends too much",
                value={"batches": self._batches, "bytes": self._bytes},
                valid={"batches": MAX_BATCHES, "bytes": MAX_BYTES},
                remedy="Send as much as a session does: some 20 batches a second for two minutes.",
            )

    async def _send(self) -> None:
        while True:
            message = await self._outbox.get()
            if isinstance(message, ReembodyError):
                raise message
            if self.socket.application_state is WebSocketState.CONNECTED:
                await self.socket.send_text(message.model_dump_json())

    async def _watch(self, subscription: Subscription) -> None:
        """Close the socket when the pairing ends, or a phase is prepared that it would disturb."""
        while True:
            if "session" in await subscription.next(timeout_s=MAX_DURATION_S):
                await asyncio.to_thread(self._require_allowed)

    def _require_allowed(self) -> None:
        """Raise NotSignedIn if the headset is no longer paired, and NotNow during a phase."""
        with self.context.database.reading() as db:
            device_of_token(db, self.token, "headset")
            require_no_phase(db, self.session_id)

    def _call(self, news: Outcome | ReembodyError) -> None:
        try:
            self._loop.call_soon_threadsafe(self._arrived, news)
        except RuntimeError:  # the event loop has closed, so there is no connection left
            return

    def _arrived(self, news: Outcome | ReembodyError) -> None:
        if isinstance(news, ReembodyError):
            self._outbox.put_nowait(news)
            return
        for _ in range(news.messages):
            self._in_flight.release()
        if news.positions:
            self._outbox.put_nowait(Ack(positions=tuple(news.positions.values())))
