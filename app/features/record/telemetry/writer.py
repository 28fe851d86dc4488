"""Commit the messages of all sessions together, every 50 ms, and only then acknowledge them.

One thread does this. So the number of flushes to disk does not grow with the number of headsets,
and an acknowledgement always means "on disk". A message that cannot be stored fails its own session
only; if the database itself cannot write, nothing is acknowledged and everything waits.
"""

import logging
import threading
import time
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol, Self

from sqlalchemy.exc import DBAPIError

from app.features.record.alarms import Change, Condition
from app.features.record.sessions import closed_sessions, refusal
from app.features.record.telemetry.ingest import Intake
from app.features.record.telemetry.positions import Outcome
from app.features.record.telemetry.reports import store_report
from app.features.record.telemetry.summaries import Summariser
from app.features.record.telemetry.trials import (
    TrialContent,
    TrialEnd,
    end_trial,
    store_trial,
)
from app.platform.context import AppContext, Part
from app.platform.trouble import explain
from app.wire import Batch, FrameFlags, Probed, Produced, Report, flag_batches

log = logging.getLogger(__name__)
RETRY_S = 0.5
WRITER = "telemetry-writer"
MAX_TRIES = 3
"""How often messages that crash the writer are tried before their senders are sent an error."""


class Sender(Protocol):
    """The sender of a message, which is notified of the result; callable from any thread."""

    def deliver(self, outcome: Outcome) -> None:
        """Process the confirmation that messages of this sender are on disk."""

    def fail(self, error: Exception) -> None:
        """Process the error that a message can never be stored; the connection must close."""


class ServerSender:
    """The sender of what the server itself records, which ignores all results."""

    def deliver(self, outcome: Outcome) -> None:
        """Do nothing, because nothing waits for the result."""

    def fail(self, error: Exception) -> None:
        """Do nothing, because the error was already logged."""


class Arrival(NamedTuple):
    """A message that is queued to be stored, of a session or of a self-test (`NO_SESSION`)."""

    session_id: str
    sender: Sender
    content: "Content"


class BatchContent(NamedTuple):
    """A decoded batch and its raw bytes."""

    batch: Batch
    message: bytes


@dataclass(frozen=True)
class ProbeContent:
    """A raw clock probe of an epoch."""

    epoch: int
    probe: Probed


@dataclass(frozen=True)
class LossContent:
    """The loss of a headset's connection or frames."""

    cause: str


@dataclass(frozen=True)
class AlarmContent:
    """The raising or clearing of an alarm, which is not acknowledged."""

    change: Change


Content = (
    BatchContent
    | Report
    | ProbeContent
    | Produced
    | LossContent
    | AlarmContent
    | TrialContent
    | TrialEnd
)


@dataclass
class TelemetryWriter(Part):
    """The only writer of telemetry. Call `start` once, and `stop` after the last connection."""

    context: AppContext
    on_phase_ended: Callable[[str, int], None]
    _waiting: list[Arrival] = field(default_factory=list)
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _wake: threading.Event = field(default_factory=threading.Event)
    _stopping: bool = False
    _tries: int = 0
    _thread: threading.Thread | None = None

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the writer of a server, which has phases summarised as they end."""
        return cls(context, context.part(Summariser).phase_ended)

    def start(self) -> None:
        """Start the writer's thread."""
        self._thread = self.context.background.thread(WRITER, self._run, critical=True)

    def stop(self) -> None:
        """Commit the queued messages and stop."""
        self._stopping = True
        self._wake.set()
        if self._thread is not None:
            self._thread.join(timeout=10.0)

    def submit(self, arrival: Arrival) -> None:
        """Queue a message; the sender limits how many of its messages are in flight."""
        with self._lock:
            self._waiting.append(arrival)
        self._wake.set()

    def _run(self) -> None:
        restarted = True
        while True:
            self._wake.wait(timeout=1.0)
            self._wake.clear()
            # Wait briefly, so that more messages share the same flush.
            if not self._stopping:
                time.sleep(self.context.settings.commit_interval_s)
            with self._lock:
                arrivals, self._waiting = self._waiting, []
            if arrivals:
                self._store_or_keep(arrivals)
            if arrivals or restarted:
                self.context.background.recovered(WRITER)
                self._record_incidents()
                restarted = False
            if self._stopping and not self._waiting:
                return

    def _store_or_keep(self, arrivals: list[Arrival]) -> None:
        """Store messages; after an unexpected error, queue them again, but only a few times.

        The writer is then restarted and retries the same messages, so nothing that is queued is
        lost.
        """
        try:
            self._store_or_wait(arrivals)
        except Exception as error:
            self._tries += 1
            if self._tries < MAX_TRIES:
                with self._lock:
                    self._waiting = arrivals + self._waiting
            else:
                self._tries = 0
                for sender in {id(one.sender): one.sender for one in arrivals}.values():
                    sender.fail(error)
            raise
        self._tries = 0

    def _store_or_wait(self, arrivals: Sequence[Arrival]) -> None:
        while True:
            while self.context.storage.must_wait() and not self._stopping:
                time.sleep(RETRY_S)
            try:
                self._store(arrivals)
            except DBAPIError:
                # The database's observer has already reported it.
                if self._stopping:
                    return
                time.sleep(RETRY_S)
            else:
                self._record_outages()
                return

    def _record_outages(self) -> None:
        """Record storage outages afterwards, each as an alarm that was raised and cleared."""
        for outage in self.context.storage.take_outages():
            condition = Condition("storage", outage.reason)
            raised = Change("raised", condition, outage.since)
            cleared = Change("cleared", condition, outage.until)
            for session_id in self.context.hub.sessions_with_headsets():
                for change in (raised, cleared):
                    self.submit(Arrival(session_id, ServerSender(), AlarmContent(change)))

    def _record_incidents(self) -> None:
        """Record background failures afterwards, each as an alarm that was raised and cleared."""
        for incident in self.context.background.take_incidents():
            code = "writer_failed" if incident.name == WRITER else "background_failed"
            condition = Condition(code, f"{incident.name}: {incident.error}")
            raised = Change("raised", condition, incident.since)
            cleared = Change("cleared", condition, incident.until)
            for session_id in self.context.hub.sessions_with_headsets():
                for change in (raised, cleared):
                    self.submit(Arrival(session_id, ServerSender(), AlarmContent(change)))

    def _store(self, arrivals: Sequence[Arrival]) -> None:
        """Commit all messages together; if a message is at fault, session by session."""
        try:
            self._commit(arrivals)
        except Exception as error:
            if explain(error) is not None:
                raise  # the storage is at fault, not a message
            sessions = {arrival.session_id for arrival in arrivals}
            if len(sessions) > 1:
                for session_id in sorted(sessions):
                    self._store([a for a in arrivals if a.session_id == session_id])
                return
            log.error("telemetry of one session cannot be stored", exc_info=error)
            for arrival in arrivals:
                arrival.sender.fail(error)

    def _commit(self, arrivals: Sequence[Arrival]) -> None:
        outcomes: dict[int, tuple[Sender, Outcome]] = {}
        flags = flag_batches(
            [one.content.batch for one in arrivals if isinstance(one.content, BatchContent)]
        )
        ended: list[tuple[str, int]] = []
        with self.context.database.writing() as db:
            closed = closed_sessions(db, {arrival.session_id for arrival in arrivals})
            intake = Intake(db, self.context, self.context.clock.utc_now())
            intake.positions.fetch(arrival.session_id for arrival in arrivals)
            intake.fetch_phases(
                arrival.session_id for arrival in arrivals if isinstance(arrival.content, Report)
            )
            for arrival in arrivals:
                if arrival.session_id in closed:
                    _leave_out(arrival, flags)
                    continue
                _, outcome = outcomes.setdefault(id(arrival.sender), (arrival.sender, Outcome()))
                _store_one(intake, arrival, flags, outcome)
                outcome.messages += not isinstance(arrival.content, LossContent | AlarmContent)
                ended += [(arrival.session_id, phase) for phase in outcome.phases_ended]
                outcome.phases_ended.clear()
            intake.flush()
        for sender, outcome in outcomes.values():
            sender.deliver(outcome)
        for session_id, phase_id in ended:
            self.on_phase_ended(session_id, phase_id)
        _refuse(arrivals, closed)


def _leave_out(arrival: Arrival, flags: Iterator[FrameFlags]) -> None:
    """Skip the flags of a batch that is not stored, as they were computed for all batches."""
    if isinstance(arrival.content, BatchContent):
        next(flags)


def _refuse(arrivals: Sequence[Arrival], closed: Collection[str]) -> None:
    """Notify every headset that sent something for a session that accepts no more data."""
    own = (LossContent, AlarmContent)
    senders = {
        id(one.sender): one.sender
        for one in arrivals
        if one.session_id in closed and not isinstance(one.content, own)
    }
    for sender in senders.values():
        sender.fail(refusal())


def _store_one(
    intake: Intake, arrival: Arrival, flags: Iterator[FrameFlags], outcome: Outcome
) -> None:
    """Store a message; `flags` yields the flags of the batches in their order."""
    session_id = arrival.session_id
    match arrival.content:
        case BatchContent(batch, message):
            intake.store_batch(session_id, batch.header, message, next(flags), outcome)
        case Report() as report:
            store_report(intake, session_id, report, outcome)
        case ProbeContent(epoch, probe):
            intake.store_probe(session_id, epoch, probe)
        case Produced() as produced:
            intake.store_produced(session_id, produced)
        case LossContent(cause):
            intake.store_loss(session_id, cause)
        case AlarmContent(change):
            intake.store_alarm(session_id, change)
        case TrialContent() as trial:
            store_trial(intake, trial, outcome)
        case TrialEnd(trial_id):
            end_trial(intake, trial_id)
