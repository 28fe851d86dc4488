"""Alarms and their conditions, the set of open alarms, and the limits of the headset watch."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from datetime import datetime
from typing import Literal

from app.features.record.alarms.kinds import ALARMS, Severity
from app.science.stream_quality import DEFAULT_LIMITS, QualityLimits

State = Literal["raised", "cleared"]

SEVERITIES: dict[str, Severity] = {one.key: one.severity for one in ALARMS}
PERSISTENT = tuple(one.key for one in ALARMS if one.of_person)
"""Alarms about the participant: they stay open until a person or a form clears them, even if the
server or the headset restarts."""


@dataclass(frozen=True)
class Moment:
    """The current time on the server: `monotonic_s` for durations, `utc` for the record."""

    monotonic_s: float
    utc: datetime


@dataclass(frozen=True)
class Condition:
    """Something that is wrong at this moment; `stream` is None unless it concerns a single stream.

    `value` with its `unit` quantifies it; `client_t_s` is when it happened, on the client's clock;
    `joints` are the joints concerned.
    """

    code: str
    message: str
    stream: str | None = None
    value: float | None = None
    unit: str | None = None
    client_t_s: float | None = None
    joints: tuple[str, ...] = ()

    @property
    def severity(self) -> Severity:
        """Return how urgent the condition is."""
        return SEVERITIES[self.code]

    @property
    def key(self) -> tuple[str, str | None]:
        """Return the alarm's key, its code and stream; at most one alarm per key is open."""
        return self.code, self.stream


@dataclass(frozen=True)
class Change:
    """The raising or clearing of an alarm, with its condition at that moment."""

    state: State
    condition: Condition
    at: datetime


@dataclass(frozen=True)
class Alarm:
    """An open alarm: its latest condition, when it was raised, and when it was last reported."""

    condition: Condition
    since: datetime
    seen_s: float


@dataclass
class OpenAlarms:
    """The open alarms of one headset.

    An alarm is raised by the first report of its condition, and cleared once the condition has not
    been reported for `clear_after_s`. So an intermittent problem does not make the page flicker.
    """

    clear_after_s: float
    _open: dict[tuple[str, str | None], Alarm] = field(default_factory=dict)

    @property
    def open(self) -> tuple[Alarm, ...]:
        """Return the open alarms, oldest first."""
        return tuple(self._open.values())

    def report(self, condition: Condition, now: Moment) -> Iterator[Change]:
        """Record a condition; yield a change if it raises an alarm."""
        existing = self._open.get(condition.key)
        if existing is None:
            self._open[condition.key] = Alarm(condition, now.utc, now.monotonic_s)
            yield Change("raised", condition, now.utc)
        else:
            self._open[condition.key] = replace(
                existing, condition=condition, seen_s=now.monotonic_s
            )

    def clear_expired(self, now: Moment) -> Iterator[Change]:
        """Clear the alarms whose conditions have not been reported for `clear_after_s`."""
        for alarm in self.open:
            if now.monotonic_s - alarm.seen_s >= self.clear_after_s:
                del self._open[alarm.condition.key]
                yield Change("cleared", alarm.condition, now.utc)

    def close(self, message: str, now: Moment) -> Iterator[Change]:
        """Clear all open alarms, with `message` as the reason."""
        for alarm in self.open:
            del self._open[alarm.condition.key]
            yield Change("cleared", replace(alarm.condition, message=message), now.utc)


@dataclass(frozen=True)
class WatchLimits:
    """The limits of a headset's quality checks, in real seconds unless named `client`.

    `silent_s`: time without a frame while frames are expected. `clock_unknown_s`: time without a
    usable clock probe. `clock_uncertain_s`: half of the smallest round trip within
    `clock_window_s`. `backlog_s`: movement that is not on disk yet. `low_rate_share`: the lowest
    tolerated share of the usual frame rate, over `low_rate_client_s`; it is slightly less than 72
    of 90 Hz, because displays do have that rate. `gap_client_s`: shorter gaps are counted but raise
    no alarm. `asleep_client_s`: the headset's page takes a longer interval for sleep, and stops the
    clock; `away_client_s`: a longer one is a device that is not used, not a slow one.
    `clear_after_s`: an alarm is cleared when its cause has been absent for so long.
    `check_every_s`: the interval between checks.
    """

    silent_s: float = 3.0
    clock_unknown_s: float = 15.0
    clock_uncertain_s: float = 0.010
    clock_window_s: float = 60.0
    backlog_s: float = 10.0
    low_rate_share: float = 0.79
    low_rate_client_s: float = 3.0
    gap_client_s: float = 0.25
    asleep_client_s: float = 0.5
    away_client_s: float = 10.0
    clear_after_s: float = 3.0
    check_every_s: float = 0.5
    quality: QualityLimits = DEFAULT_LIMITS

    def at_scale(self, time_scale: float) -> "WatchLimits":
        """Return the limits for a session that runs `time_scale` times as fast as real time.

        A simulated client that runs faster than real time waits for the server and shares its
        machine, so it need not send a steady stream: it may be silent ten times as long. With a
        client that runs slower, whatever is judged once per client second is judged less often, so
        alarms clear later.
        """
        if time_scale > 1.0:
            return replace(self, silent_s=10.0 * self.silent_s)
        return replace(self, clear_after_s=self.clear_after_s / time_scale)
