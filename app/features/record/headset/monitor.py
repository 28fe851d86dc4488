"""What happens beside storing: figures for the console, and a watch over the quality of the data.

Nothing here holds up the telemetry: it runs on what has been received, and its alarms go to the
writer like any message, without anybody waiting for them.
"""

import asyncio
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

from app.features.record.alarms import Alarm, Change, Condition, Moment, QualityWatch, WatchLimits
from app.features.record.doubts import OBSERVED
from app.features.record.headset.poses import PoseFeed
from app.features.record.telemetry import AlarmContent, Content, LiveTelemetry, LossContent, Outcome
from app.platform.context import AppContext
from app.wire import Batch, HeadsetState, Probed, Produced, Report, Welcome

NEWS_EVERY_S = 1.0


@dataclass
class HeadsetMonitor:
    """The monitor of one connection. `submit` hands something over to the writer."""

    context: AppContext
    session_id: str
    submit: Callable[[Content], None]
    welcome: Welcome
    live: LiveTelemetry = field(default_factory=LiveTelemetry)
    poses: PoseFeed = field(init=False)
    watch: QualityWatch = field(init=False)
    _told_s: float = 0.0
    _observed: bool = False

    def __post_init__(self) -> None:
        self.poses = PoseFeed(self.context.hub, self.session_id)
        limits = WatchLimits(silent_s=self.context.settings.headset_silent_s)
        self.watch = QualityWatch.of(self.welcome, limits, self._now())
        back = Condition("disconnected", "the headset is back")
        self.submit(AlarmContent(Change("cleared", back, self._now().utc)))

    def _now(self) -> Moment:
        clock = self.context.clock
        return Moment(clock.monotonic_ns() / 1e9, clock.utc_now())

    def batch(self, batch: Batch) -> None:
        """Frames have come and were handed over to the writer."""
        now = self._now()
        self.context.hub.note_frames(self.session_id, now.monotonic_s)
        self.poses.take(batch, now.monotonic_s)
        self.live.take(batch)
        changes = self.watch.batch(batch, now)
        self._store(changes)
        if self._has_listeners():
            figures = self.live.figures(now.monotonic_s)
            if figures is not None or changes:
                self._tell(figures or {}, now)

    def report(self, report: Report) -> None:
        """A report has come."""
        self.live.count(report)
        self.poses.report(report)

    def probed(self, reading: Probed) -> None:
        """A reading of the clocks has come."""
        self.watch.probed(reading, self._now())

    def observe(self, words: str) -> None:
        """What has just come cannot be true, and only this connection can see it."""
        if not self._observed:
            self._observed = True
            self.submit(AlarmContent(Change("raised", Condition(OBSERVED, words), self._now().utc)))

    def produced(self, message: Produced) -> None:
        """The client says how far it has come."""
        self.watch.produced(message)

    def delivered(self, outcome: Outcome, *, waiting: bool) -> None:
        """Something is on disk; other messages are `waiting`, or none."""
        self.live.flagged(outcome.frames_flagged)
        self.watch.backlog.stored(outcome.positions.values())
        self.watch.backlog.acknowledged(self._now().monotonic_s, waiting=waiting)

    def update_state(self, state: HeadsetState) -> None:
        """The session has changed."""
        self.watch.update_state(state, self._now())

    async def run(self, is_reading: Callable[[], bool]) -> None:
        """Look up now and then, also when nothing comes, until cancelled."""
        while True:
            await asyncio.sleep(self.watch.limits.check_every_s)
            self._check(reading=is_reading())

    def _check(self, *, reading: bool) -> None:
        now = self._now()
        self.watch.silence.frame_arrived(self.context.hub.frames_heard_s(self.session_id))
        result = self.watch.check(now, reading=reading)
        self._store(result.changes)
        if result.phase_is_lost:
            self.submit(LossContent("headset_silent"))
        self.context.hub.note_signal(self.session_id, self.watch.signal(now))
        due = now.monotonic_s - self._told_s >= NEWS_EVERY_S
        if (result.changes or due) and self._has_listeners():
            self._tell({}, now)

    def leave(self, *, connected: bool) -> None:
        """The socket has closed; the session has another one that is `connected`, or none."""
        now = self._now()
        self._store(self.watch.alarms.close("the headset's connection has closed", now))
        gone: list[Alarm] = []
        if self.watch.recording and not connected:
            lost = Condition("disconnected", "The headset's connection has broken off")
            gone = [Alarm(lost, now.utc, now.monotonic_s)]
            self._store([Change("raised", lost, now.utc)])
        if not connected:
            self._publish({"signal": None, "alarms": [_told(alarm) for alarm in gone]})

    def _store(self, changes: Iterable[Change]) -> None:
        for change in changes:
            self.submit(AlarmContent(change))

    def _has_listeners(self) -> bool:
        return self.context.hub.has_listeners(self.session_id, "telemetry")

    def _tell(self, figures: dict[str, Any], now: Moment) -> None:
        """News: figures when there are frames, and always how good the data are."""
        self._told_s = now.monotonic_s
        alarms = [_told(alarm) for alarm in self.watch.open]
        self._publish({**figures, "signal": self.watch.signal(now), "alarms": alarms})

    def _publish(self, news: dict[str, Any]) -> None:
        self.context.hub.publish(self.session_id, "telemetry", news)


def _told(alarm: Alarm) -> dict[str, Any]:
    """An open alarm as the console hears of it."""
    condition = alarm.condition
    return {
        "code": condition.code,
        "severity": condition.severity,
        "stream": condition.stream,
        "message": condition.message,
        "value": condition.value,
        "unit": condition.unit,
        "joints": list(condition.joints),
        "since": alarm.since.isoformat(),
    }
