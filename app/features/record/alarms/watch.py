"""The watch of one headset: hears everything it says, and says what is wrong."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

from app.features.record.alarms.alarm import (
    Alarm,
    AlarmBook,
    Change,
    Condition,
    Moment,
    WatchLimits,
)
from app.features.record.alarms.backlog_watch import BacklogWatch
from app.features.record.alarms.clock_watch import ClockWatch
from app.features.record.alarms.silence_watch import SilenceWatch
from app.features.record.alarms.stream_watch import StreamWatch
from app.wire import Batch, HeadsetState, Probed, Produced, StreamName, Welcome


@dataclass(frozen=True)
class Look:
    """What a look up gave: changes of alarms, and whether a running phase is without frames."""

    changes: tuple[Change, ...]
    phase_is_lost: bool


@dataclass
class QualityWatch:
    """Everything that is watched of one open socket. Knows no database and no event loop.

    Make it with `QualityWatch.of(welcome, ...)`, tell it what the headset sends and what becomes of
    it, and call `look` about every `limits.look_every_s`.
    """

    limits: WatchLimits
    time_scale: float
    clock: ClockWatch
    silence: SilenceWatch
    backlog: BacklogWatch
    book: AlarmBook
    _streams: dict[tuple[StreamName, int], StreamWatch] = field(default_factory=dict)
    _stored: dict[tuple[str, int], int] = field(default_factory=dict)
    _newest: dict[StreamName, StreamWatch] = field(default_factory=dict)

    @classmethod
    def of(cls, welcome: Welcome, limits: WatchLimits, now: Moment) -> "QualityWatch":
        """The watch of a headset that has just been welcomed."""
        limits = limits.at_scale(welcome.time_scale)
        watch = cls(
            limits=limits,
            time_scale=welcome.time_scale,
            clock=ClockWatch(limits, welcome.time_scale, now.monotonic_s),
            silence=SilenceWatch(limits, now.monotonic_s),
            backlog=BacklogWatch(limits),
            book=AlarmBook(limits.clear_after_s),
            _stored={(str(p.stream), p.epoch): p.next_seq for p in welcome.positions},
        )
        watch.backlog.stored(welcome.positions)
        watch.follow(welcome.state, now)
        return watch

    @property
    def recording(self) -> bool:
        """Whether frames are wanted."""
        return self.silence.recording

    @property
    def open(self) -> tuple[Alarm, ...]:
        """What is wrong now."""
        return self.book.open

    def follow(self, state: HeadsetState, now: Moment) -> None:
        """The session has changed."""
        phase = state.phase
        running = phase is not None and phase.status == "running"
        self.silence.follow(now.monotonic_s, recording=state.recording, running=running)

    def batch(self, batch: Batch, now: Moment) -> tuple[Change, ...]:
        """Frames have come."""
        header = batch.header
        self.silence.heard(now.monotonic_s)
        self.backlog.handed_over(now.monotonic_s)
        watch = self._of(header.stream, header.epoch)
        return self._report(watch.take(batch), now)

    def _of(self, stream: StreamName, epoch: int) -> StreamWatch:
        watch = self._streams.get((stream, epoch))
        if watch is None:
            next_seq = self._stored.get((str(stream), epoch), 0)
            watch = self._streams[stream, epoch] = StreamWatch(stream, self.limits, next_seq)
        self._newest[stream] = watch
        return watch

    def probed(self, reading: Probed, now: Moment) -> None:
        """An exchange of clock readings has come."""
        self.clock.probed(reading, now.monotonic_s)

    def produced(self, message: Produced) -> None:
        """The client says how far it has come."""
        target = self._newest.get(StreamName.TARGET)
        if target is not None and target.usual_s is not None:
            self.backlog.frames_per_s = self.time_scale / target.usual_s
        self.backlog.produced(message)

    def look(self, now: Moment, *, reading: bool = True) -> Look:
        """What has changed without a word from the headset.

        `reading` False: the server itself has stopped reading, so silence says nothing.
        """
        self.silence.look_up(now.monotonic_s, reading=reading)
        self.clock.usable_s = max(self.clock.usable_s, self.silence.unheard_until_s)
        found: list[Condition] = [
            *self.silence.look(now.monotonic_s),
            *self.clock.look(now.monotonic_s),
            *self.backlog.look(now.monotonic_s),
        ]
        changes = (*self._report(found, now), *self.book.settle(now))
        return Look(changes, self.silence.phase_is_lost(now.monotonic_s))

    def _report(self, conditions: Iterable[Condition], now: Moment) -> tuple[Change, ...]:
        def changes() -> Iterator[Change]:
            for condition in conditions:
                yield from self.book.report(condition, now)

        return tuple(changes())

    def signal(self, now: Moment) -> dict[str, Any]:
        """The figures of the console's signal card; null where unknown."""
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
            "clock_uncertainty_ms": None
            if uncertainty_s is None
            else round(1e3 * uncertainty_s, 1),
            "behind_s": round(self.backlog.behind_s(now.monotonic_s), 1),
        }
