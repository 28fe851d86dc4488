"""Monitor one headset: collect everything it sends, and raise and clear alarms."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

from app.features.record.alarms.alarm import (
    Alarm,
    Change,
    Condition,
    Moment,
    OpenAlarms,
    WatchLimits,
)
from app.features.record.alarms.watches.backlog import BacklogWatch
from app.features.record.alarms.watches.clock import ClockWatch
from app.features.record.alarms.watches.feet import FeetWatch
from app.features.record.alarms.watches.silence import SilenceWatch
from app.features.record.alarms.watches.stream import StreamWatch
from app.wire import FINGER_STREAMS, Batch, HeadsetState, Probed, Produced, StreamName, Welcome

WITHOUT_SENSORS = frozenset({"desktop", "script"})
"""Sources of poses, by the names of the headset's page, that nothing measures."""
OF_SENSORS = frozenset({"frozen", "jump"})
"""Conditions whose remedy is at a sensor: a computed pose may well rest to the last digit."""


@dataclass(frozen=True)
class CheckResult:
    """The result of a periodic check: alarm changes, and whether a running phase lacks frames."""

    changes: tuple[Change, ...]
    phase_is_lost: bool


@dataclass
class QualityWatch:
    """Runs all checks on one open headset socket, without using the database or the event loop.

    Create it with `QualityWatch.of(welcome, ...)`, pass it what the headset sends and what was
    stored, and call `check` about every `limits.check_every_s`.
    """

    limits: WatchLimits
    time_scale: float
    clock: ClockWatch
    silence: SilenceWatch
    backlog: BacklogWatch
    alarms: OpenAlarms
    feet: FeetWatch = field(default_factory=FeetWatch)
    _streams: dict[tuple[StreamName, int], StreamWatch] = field(default_factory=dict)
    _stored: dict[tuple[str, int], int] = field(default_factory=dict)
    _newest: dict[StreamName, StreamWatch] = field(default_factory=dict)

    @classmethod
    def of(cls, welcome: Welcome, limits: WatchLimits, now: Moment) -> "QualityWatch":
        """Create the watch of a headset that has just been welcomed."""
        limits = limits.at_scale(welcome.time_scale)
        watch = cls(
            limits=limits,
            time_scale=welcome.time_scale,
            clock=ClockWatch(limits, welcome.time_scale, now.monotonic_s),
            silence=SilenceWatch(limits, now.monotonic_s),
            backlog=BacklogWatch(limits),
            alarms=OpenAlarms(limits.clear_after_s),
            _stored={(str(p.stream), p.epoch): p.next_seq for p in welcome.positions},
        )
        watch.backlog.stored(welcome.positions)
        watch.update_state(welcome.state, now)
        return watch

    @property
    def recording(self) -> bool:
        """Return whether frames are expected."""
        return self.silence.recording

    @property
    def is_worn(self) -> bool:
        """Return whether sensors measure the participant, which is assumed until it is told."""
        goals = self.feet.goals
        return goals is None or goals.source not in WITHOUT_SENSORS

    @property
    def open(self) -> tuple[Alarm, ...]:
        """Return the open alarms, oldest first."""
        return self.alarms.open

    def update_state(self, state: HeadsetState, now: Moment) -> None:
        """Apply a new state of the session."""
        phase = state.phase
        running = phase is not None and phase.status == "running"
        self.silence.set_expected(now.monotonic_s, recording=state.recording, running=running)
        self.feet.update_state(state)

    def batch(self, batch: Batch, now: Moment) -> tuple[Change, ...]:
        """Examine a batch of frames that has arrived, and return the changes of alarms."""
        header = batch.header
        self.silence.frame_arrived(now.monotonic_s)
        self.backlog.submitted(now.monotonic_s)
        if header.stream in FINGER_STREAMS:
            # Streams of fingers have the same frames as those of the body, whose gaps and rate are
            # watched. A finger that jumps or rests is no fault: trackers lose and find hands all
            # the time. Broken values are flagged and counted where they are stored.
            return ()
        watch = self._stream_watch(header.stream, header.epoch)
        found = watch.take(batch)
        if not self.is_worn:
            found = (one for one in found if one.code not in OF_SENSORS)
        return self._report(found, now)

    def _stream_watch(self, stream: StreamName, epoch: int) -> StreamWatch:
        watch = self._streams.get((stream, epoch))
        if watch is None:
            next_seq = self._stored.get((str(stream), epoch), 0)
            watch = self._streams[stream, epoch] = StreamWatch(stream, self.limits, next_seq)
        self._newest[stream] = watch
        return watch

    def probed(self, reading: Probed, now: Moment) -> None:
        """Record a clock probe that has arrived."""
        self.clock.probed(reading, now.monotonic_s)

    def produced(self, message: Produced) -> None:
        """Record the client's report of how many frames it has produced."""
        target = self._newest.get(StreamName.TARGET)
        if target is not None and target.usual_s is not None:
            self.backlog.frames_per_s = self.time_scale / target.usual_s
        self.backlog.produced(message)

    def check(self, now: Moment, *, reading: bool = True) -> CheckResult:
        """Run the checks that do not depend on a message from the headset.

        `reading` is False while the server has stopped reading, so that silence means nothing.
        """
        self.silence.note_check(now.monotonic_s, reading=reading)
        self.clock.usable_s = max(self.clock.usable_s, self.silence.unread_until_s)
        found: list[Condition] = [
            *self.silence.check(now.monotonic_s, is_worn=self.is_worn),
            *self.clock.check(now.monotonic_s),
            *self.backlog.check(now.monotonic_s),
            *self.feet.check(),
        ]
        changes = (*self._report(found, now), *self.alarms.clear_expired(now))
        return CheckResult(changes, self.silence.phase_is_lost(now.monotonic_s))

    def _report(self, conditions: Iterable[Condition], now: Moment) -> tuple[Change, ...]:
        def changes() -> Iterator[Change]:
            for condition in conditions:
                yield from self.alarms.report(condition, now)

        return tuple(changes())

    def signal(self, now: Moment) -> dict[str, Any]:
        """Return the figures of the console's signal card; unknown ones are null."""
        target = self._newest.get(StreamName.TARGET)
        rate_hz = None if target is None else target.frame_rate_hz
        if self.silence.is_quiet(now.monotonic_s):
            rate_hz = 0.0 if self.recording else None
        usual_s = None if target is None else target.usual_s
        tallies = [watch.tally for watch in self._newest.values()]
        uncertainty_s = self.clock.uncertainty_s(now.monotonic_s)
        return {
            "frame_rate_hz": None if rate_hz is None else round(rate_hz, 1),
            "usual_rate_hz": None if usual_s is None else round(1.0 / usual_s, 1),
            "gaps": max((tally.gaps for tally in tallies), default=0),
            "gap_s": round(max((tally.gap_s for tally in tallies), default=0.0), 2),
            "frames_flagged": sum(tally.flagged for tally in tallies),
            "frames_flagged_of_participant": 0 if target is None else target.tally.flagged,
            "clock_uncertainty_ms": None
            if uncertainty_s is None
            else round(1e3 * uncertainty_s, 1),
            "behind_s": round(self.backlog.lag_s(now.monotonic_s), 1),
        }
