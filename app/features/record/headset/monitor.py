"""Monitor a headset's connection: live figures for the console, and alarms about data quality.

Nothing here delays the telemetry: the monitor works on what has already been received, and its
alarms are submitted to the writer like any message, without waiting for them to be stored.
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
from app.wire import Batch, GoalsReport, HeadsetState, Probed, Produced, Report, Welcome

PUBLISH_EVERY_S = 1.0


@dataclass
class HeadsetMonitor:
    """The monitor of one connection. `submit` passes content to the telemetry writer."""

    context: AppContext
    session_id: str
    submit: Callable[[Content], None]
    welcome: Welcome
    live: LiveTelemetry = field(default_factory=LiveTelemetry)
    goals: GoalsReport | None = None
    poses: PoseFeed = field(init=False)
    watch: QualityWatch = field(init=False)
    _published_s: float = 0.0
    _impossible_reported: bool = False

    def __post_init__(self) -> None:
        self.poses = PoseFeed(self.context.hub, self.session_id)
        limits = WatchLimits(silent_s=self.context.settings.headset_silent_s)
        self.live.wear(self.welcome.state.phase)
        self.watch = QualityWatch.of(self.welcome, limits, self._now())
        # A reconnected run does not repeat what it has reported.
        self.watch.feet.goals = self.goals
        back = Condition("disconnected", "the headset is back")
        self.submit(AlarmContent(Change("cleared", back, self._now().utc)))

    def _now(self) -> Moment:
        clock = self.context.clock
        return Moment(clock.monotonic_ns() / 1e9, clock.utc_now())

    def batch(self, batch: Batch) -> None:
        """Process a batch of frames that was received and submitted to the writer."""
        now = self._now()
        self.context.hub.note_frames(self.session_id, now.monotonic_s)
        self.poses.take(batch, now.monotonic_s)
        self.live.take(batch)
        changes = self.watch.batch(batch, now)
        self._store(changes)
        if self._has_listeners():
            figures = self.live.figures(now.monotonic_s)
            if figures is not None or changes:
                self._publish_figures(figures or {}, now)

    def report(self, report: Report) -> None:
        """Process a report of the headset, such as a contact or a completed task."""
        self.live.count(report)
        self.poses.report(report)
        if isinstance(report.body, GoalsReport):
            self.watch.feet.goals = report.body

    def probed(self, reading: Probed) -> None:
        """Process a clock probe."""
        self.watch.probed(reading, self._now())

    def report_impossible(self, message: str) -> None:
        """Raise an alarm for an impossible message, which only this connection can detect."""
        if not self._impossible_reported:
            self._impossible_reported = True
            self.submit(
                AlarmContent(Change("raised", Condition(OBSERVED, message), self._now().utc))
            )

    def produced(self, message: Produced) -> None:
        """Process the client's report of how many frames it has produced."""
        self.watch.produced(message)

    def delivered(self, outcome: Outcome, *, waiting: bool) -> None:
        """Process the storing of messages; `waiting`: others are still to be stored."""
        self.live.flagged(outcome.frames_flagged)
        self.watch.backlog.stored(outcome.positions.values())
        self.watch.backlog.acknowledged(self._now().monotonic_s, waiting=waiting)

    def update_state(self, state: HeadsetState) -> None:
        """Apply a new state of the session."""
        self.live.wear(state.phase)
        self.watch.update_state(state, self._now())

    async def run(self, is_reading: Callable[[], bool]) -> None:
        """Run the periodic checks until cancelled, even if no messages arrive."""
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
        due = now.monotonic_s - self._published_s >= PUBLISH_EVERY_S
        if (result.changes or due) and self._has_listeners():
            self._publish_figures({}, now)

    def leave(self, *, connected: bool) -> None:
        """Handle the closing of the socket; `connected`: the session still has another one."""
        now = self._now()
        self._store(self.watch.alarms.close("the headset's connection has closed", now))
        open_alarms: list[Alarm] = []
        if self.watch.recording and not connected:
            lost = Condition("disconnected", "The headset's connection was lost")
            open_alarms = [Alarm(lost, now.utc, now.monotonic_s)]
            self._store([Change("raised", lost, now.utc)])
        if not connected:
            self._publish({"signal": None, "alarms": [_alarm_view(one) for one in open_alarms]})

    def _store(self, changes: Iterable[Change]) -> None:
        for change in changes:
            self.submit(AlarmContent(change))

    def _has_listeners(self) -> bool:
        return self.context.hub.has_listeners(self.session_id, "telemetry")

    def _publish_figures(self, figures: dict[str, Any], now: Moment) -> None:
        """Publish figures (if there are any), the signal quality and the open alarms."""
        self._published_s = now.monotonic_s
        alarms = [_alarm_view(alarm) for alarm in self.watch.open]
        self._publish({**figures, "signal": self.watch.signal(now), "alarms": alarms})

    def _publish(self, news: dict[str, Any]) -> None:
        self.context.hub.publish(self.session_id, "telemetry", news)


def _alarm_view(alarm: Alarm) -> dict[str, Any]:
    """Return an open alarm in the form in which the console receives it."""
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
