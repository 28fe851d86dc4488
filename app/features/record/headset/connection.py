"""The connection of one headset: tasks that read, send, push the session's state, and monitor.

Everything received is stored by the telemetry writer. Reading stops while too many messages wait
for the disk: the client then feels TCP's backpressure and its journal grows visibly, instead of
anything being dropped.
"""

import asyncio
import enum
import logging
from collections import deque
from collections.abc import Callable, Coroutine, Iterable
from dataclasses import dataclass, field
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from app.errors import InvalidInput, TakenOver, Withdrawn
from app.features.record.headset.goals import newest_goals
from app.features.record.headset.monitor import HeadsetMonitor
from app.features.record.headset.service import headset_state, welcome
from app.features.record.telemetry import (
    Arrival,
    BatchContent,
    Content,
    LiveTelemetry,
    LossContent,
    Outcome,
    ProbeContent,
    TelemetryWriter,
    live_telemetry,
)
from app.platform.access import session_by_id
from app.platform.context import AppContext
from app.platform.hub import Subscription
from app.platform.text import require_text_in_json
from app.platform.tokens import device_of_token
from app.wire import (
    CLIENT_MESSAGE,
    PROTOCOL_VERSION,
    Ack,
    ClientMessages,
    Failure,
    GoalsReport,
    HeadsetState,
    Hello,
    Message,
    Probe,
    ProbeAnswer,
    Probed,
    Produced,
    Report,
    Welcome,
    decode_batch,
)

log = logging.getLogger(__name__)
MAX_IN_FLIGHT = 64
"""About two seconds of messages; more would let one reconnecting client starve the others."""
HELLO_DEADLINE_S = 10.0
MAX_PROBE_ANSWERS = 64
ECHO_NS = 1_000_000
"""Tolerance of an echoed time: a client that stores numbers as doubles rounds nanoseconds."""
Argument = TypeVar("Argument")
Kind = TypeVar("Kind")
CLOSE_REFUSED = 4400
TAKEN_OVER = "taken_over"
"""The topic on which the newest connection of a session makes itself known to the older ones."""


class StateDue(enum.Enum):
    """What the outbox holds in the place of a state, which is read when its turn comes."""

    NEWS = "news"
    """Something about the session has changed."""
    BEFORE_ACK = "before_ack"
    """An acknowledgement follows; the state is sent if the client does not have it yet."""


@dataclass(eq=False)
class HeadsetConnection:
    """An open socket of a headset. The methods that the writer calls are safe from its thread."""

    socket: WebSocket
    context: AppContext
    writer: TelemetryWriter
    session_id: str
    token: str
    epoch: int = 0
    monitor: HeadsetMonitor = field(init=False)
    _loop: asyncio.AbstractEventLoop = field(default_factory=asyncio.get_running_loop)
    _outbox: asyncio.Queue[Message | StateDue] = field(default_factory=asyncio.Queue)
    _in_flight: asyncio.Semaphore = field(default_factory=lambda: asyncio.Semaphore(MAX_IN_FLIGHT))
    _abilities: frozenset[str] = frozenset()
    _state_sent: HeadsetState | None = None
    _unanswered: int = 0
    _answers: deque[ProbeAnswer] = field(default_factory=lambda: deque(maxlen=MAX_PROBE_ANSWERS))

    def deliver(self, outcome: Outcome) -> None:
        """Handle messages that are now on disk; called by the writer."""
        self._call(self._delivered, outcome)

    def fail(self, error: Exception) -> None:
        """Report to the headset that its messages cannot be stored; called by the writer."""
        message = Failure(code="not_stored", message=str(error)[:300], remedy="Reconnect.")
        if isinstance(error, Withdrawn):
            message = Failure(code=error.code, message=error.message, remedy=error.remedy)
        self._call(self._outbox.put_nowait, message)

    async def run(self) -> None:
        """Serve the socket until it closes."""
        await self._handshake()
        with self.context.hub.subscribe(self.session_id, TAKEN_OVER) as subscription:
            # One body is worn by one page: two would record the same phase side by side.
            self.context.hub.publish(self.session_id, TAKEN_OVER, self)
            self.context.hub.headset_joined(self.session_id, abilities=self._abilities)
            self.context.hub.publish(self.session_id, "session")
            try:
                await until_one_ends(
                    self._read(),
                    self._send_outbox(),
                    self._push_state(subscription),
                    self.monitor.run(lambda: not self._in_flight.locked()),
                )
            finally:
                self._leave()

    def _leave(self) -> None:
        self.context.hub.headset_left(self.session_id, self.context.clock.utc_now())
        connected = self.context.hub.headset_connected(self.session_id)
        if not connected:
            self._submit(LossContent("headset_lost"))
        self.monitor.leave(connected=connected)
        self.context.hub.publish(self.session_id, "session")

    async def _handshake(self) -> None:
        """Receive the hello message and answer it with a welcome."""
        first = await asyncio.wait_for(next_message(self.socket), HELLO_DEADLINE_S)
        text = first if isinstance(first, str) else ""
        hello = parse_message(text)
        if not isinstance(hello, Hello) or hello.protocol != PROTOCOL_VERSION:
            raise InvalidInput(
                "the first message must be a hello of this protocol",
                value=text[:200],
                valid={"type": "hello", "protocol": PROTOCOL_VERSION},
                remedy="Update the client.",
            )
        self._abilities = hello.abilities
        answer, live, goals = await asyncio.to_thread(self._welcome, hello)
        self.epoch = answer.epoch
        self.monitor = HeadsetMonitor(
            self.context, self.session_id, self._submit, answer, live, goals
        )
        self._state_sent = answer.state
        await self._send(answer)

    def _welcome(self, hello: Hello) -> tuple[Welcome, LiveTelemetry, GoalsReport | None]:
        now = self.context.clock.utc_now()
        with self.context.database.writing() as db:
            answer = welcome(db, self.session_id, hello, now)
        # For a physics avatar this loads compiled code, so it runs neither in the write transaction
        # nor in
        # the event loop.
        with self.context.database.reading() as db:
            goals = newest_goals(db, self.session_id) if hello.goals else None
            return answer, live_telemetry(db, self.session_id, answer.bodies or ()), goals

    async def _read(self) -> None:
        while True:
            message = await next_message(self.socket)
            if isinstance(message, bytes):
                await self._handle_batch(message)
            else:
                await self._handle_text(message)

    async def _handle_batch(self, message: bytes) -> None:
        batch = decode_batch(message)
        self._require_epoch(batch.header.epoch)
        await self._store(BatchContent(batch, message))
        # The live view does not wait for the commit.
        self.monitor.batch(batch)

    async def _handle_text(self, text: str) -> None:
        received_ns = self.context.clock.monotonic_ns()
        message = parse_message(text)
        match message:
            case Report():
                self._require_epoch(message.epoch)
                self.monitor.report(message)
                await self._store(message)
            case Probe():
                answer = ProbeAnswer(
                    client_sent_s=message.client_sent_s,
                    server_received_ns=received_ns,
                    server_sent_ns=self.context.clock.monotonic_ns(),
                )
                self._answers.append(answer)
                await self._send(answer)
            case Probed():
                self.monitor.probed(message)
                if not can_be_true(message, self._answers):
                    sent_s = f"{message.client_sent_s:.3f} s"
                    self.monitor.report_impossible(
                        f"the clock probe sent at {sent_s} does not match the server's answer"
                    )
                await self._store(ProbeContent(self.epoch, message))
            case Produced():
                self._require_epoch(message.epoch)
                self.monitor.produced(message)
                await self._store(message)
            case Hello():
                raise InvalidInput("hello came twice", remedy="Open a new connection.")

    async def _store(self, content: Content) -> None:
        await self._in_flight.acquire()
        self._unanswered += 1
        self._submit(content)

    def _submit(self, content: Content) -> None:
        self.writer.submit(Arrival(self.session_id, self, content))

    def _delivered(self, outcome: Outcome) -> None:
        # One outcome acknowledges all messages of the same commit.
        for _ in range(min(outcome.messages, self._unanswered)):
            self._in_flight.release()
        self._unanswered = max(0, self._unanswered - outcome.messages)
        self.monitor.delivered(outcome, waiting=self._unanswered > 0)
        if outcome.changed_state:
            # The state that includes a report goes before the report's acknowledgement: a client
            # whose reports are all acknowledged may act on the state that it has.
            self._outbox.put_nowait(StateDue.BEFORE_ACK)
        if outcome.positions:
            self._outbox.put_nowait(Ack(positions=tuple(outcome.positions.values())))
        for notice in outcome.notices:
            self._outbox.put_nowait(notice)

    async def _send_outbox(self) -> None:
        while True:
            message = await self._outbox.get()
            if isinstance(message, StateDue):
                await self._send_state(message)
                continue
            await self._send(message)
            if isinstance(message, Failure):
                await self.socket.close(CLOSE_REFUSED)
                return

    async def _push_state(self, subscription: Subscription) -> None:
        """Have the session's state sent on every change.

        Raises NotSignedIn when the pairing was revoked, and TakenOver when a newer connection
        opened.
        """
        # Staggered, so that connections opened together do not query the database simultaneously
        # for ever.
        pairing_checked_s = 10.0 + int(self.session_id[:4], 16) / 0x2000
        while True:
            news = await subscription.next(timeout_s=pairing_checked_s)
            if news.get(TAKEN_OVER, self) is not self:
                await asyncio.to_thread(self._require_pairing)
                raise TakenOver(
                    "another page of this headset is connected to the session now",
                    remedy="Continue there, and close this page; to continue here, reload it.",
                )
            if not news:
                await asyncio.to_thread(self._require_pairing)
            if "session" in news:
                self._outbox.put_nowait(StateDue.NEWS)

    async def _send_state(self, due: StateDue) -> None:
        """Send the newest state.

        Only the outbox calls it: so a client never gets an older state after a newer one.
        """
        state = await asyncio.to_thread(self._state)
        if due is StateDue.BEFORE_ACK and state == self._state_sent:
            return
        self.monitor.update_state(state)
        self._state_sent = state
        await self._send(state)

    def _state(self) -> HeadsetState:
        with self.context.database.reading() as db:
            device_of_token(db, self.token, "headset")
            session = session_by_id(db, self.session_id)
            return headset_state(db, session, abilities=self._abilities)

    def _require_pairing(self) -> None:
        with self.context.database.reading() as db:
            device_of_token(db, self.token, "headset")

    def _require_epoch(self, epoch: int) -> None:
        if epoch != self.epoch and epoch > self.epoch:
            raise InvalidInput(
                f"epoch {epoch} was not given out",
                value=epoch,
                valid=self.epoch,
                remedy="Use the epoch of the welcome message, or an earlier one of this session.",
            )

    async def _send(self, message: Message) -> None:
        if self.socket.application_state is WebSocketState.CONNECTED:
            await self.socket.send_text(message.model_dump_json())

    def _call(self, function: Callable[[Argument], object], argument: Argument) -> None:
        try:
            self._loop.call_soon_threadsafe(function, argument)
        except RuntimeError:  # the event loop has closed, so there is no connection left
            return


async def until_one_ends(*coroutines: Coroutine[Any, Any, None]) -> None:
    """Run coroutines side by side until one ends, end the others, and raise what it raised."""
    tasks = [asyncio.create_task(one) for one in coroutines]
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        for task in done:
            task.result()
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def next_message(socket: WebSocket) -> bytes | str:
    """Return the next message; raise WebSocketDisconnect if the headset has closed the socket."""
    received = await socket.receive()
    if received["type"] == "websocket.disconnect":
        raise WebSocketDisconnect(received.get("code", 1005))
    message: bytes | None = received.get("bytes")
    return (received.get("text") or "") if message is None else message


async def next_of(socket: WebSocket, kind: TypeAdapter[Kind]) -> Kind:
    """Return the next message, read as one of this kind.

    Raises InvalidInput, which names the first invalid field, and what `next_message` raises.
    """
    message = await next_message(socket)
    try:
        return kind.validate_json(message)
    except ValidationError as error:
        raise _not_understood(error, str(message[:200])) from error


def can_be_true(reading: Probed, answers: Iterable[ProbeAnswer]) -> bool:
    """Return whether a clock probe can be true: it echoes an answer of ours, in a possible order.

    A probe that was not answered is always possible.
    """
    sent_s, received_s = reading.client_sent_s, reading.client_received_s
    if received_s is None or reading.server_received_ns is None or reading.server_sent_ns is None:
        return True
    return received_s >= sent_s and any(
        answer.client_sent_s == sent_s
        and abs(answer.server_received_ns - reading.server_received_ns) <= ECHO_NS
        and abs(answer.server_sent_ns - reading.server_sent_ns) <= ECHO_NS
        for answer in answers
    )


def parse_message(text: str) -> ClientMessages:
    """Parse a client's message; raises InvalidInput, which names the first invalid field."""
    require_text_in_json(text)
    try:
        return CLIENT_MESSAGE.validate_json(text)
    except ValidationError as error:
        raise _not_understood(error, text[:200]) from error


def _not_understood(error: ValidationError, text: str) -> InvalidInput:
    first = error.errors(include_url=False, include_input=False)[0]
    place = ".".join(map(str, first["loc"]))[:100]
    at = f" at {place}" if place else ""
    return InvalidInput(
        f"message not understood: {first['msg'][:300]}{at}",
        value=text,
        remedy="See docs/protocol.md for the messages.",
    )
