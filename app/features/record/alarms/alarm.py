"""An alarm, and the book that opens and closes them without flicker."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from datetime import datetime
from typing import Literal

from app.features.record.alarms.kinds import ALARMS, Severity
from app.science.stream_quality import USUAL, QualityLimits

State = Literal["raised", "cleared"]

SEVERITIES: dict[str, Severity] = {one.key: one.severity for one in ALARMS}
STANDING = tuple(one.key for one in ALARMS if one.of_person)
"""Alarms about the participant: they hold until a person or a form says otherwise, whatever becomes
of the server and the headset in between."""


@dataclass(frozen=True)
class Moment:
    """Now, on the server: `monotonic_s` for durations, `utc` for the record."""

    monotonic_s: float
    utc: datetime


@dataclass(frozen=True)
class Condition:
    """Something is wrong at this moment. `stream` None: not with one stream alone.

    `value` with its `unit` says how much; `client_t_s` when it was, on the client's clock; `joints`
    which joints are meant.
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
        """How urgent it is."""
        return SEVERITIES[self.code]

    @property
    def key(self) -> tuple[str, str | None]:
        """An alarm is open once for each code and stream."""
        return self.code, self.stream


@dataclass(frozen=True)
class Change:
    """An alarm was raised or cleared; `condition` as it was at that moment."""

    state: State
    condition: Condition
    at: datetime


@dataclass(frozen=True)
class Alarm:
    """An alarm that is open: its newest condition, and since when."""

    condition: Condition
    since: datetime
    seen_s: float


@dataclass
class AlarmBook:
    """The open alarms of one headset.

    An alarm is raised by the first condition and cleared once there was none for `clear_after_s`:
    so that what comes and goes does not make the page flicker.
    """

    clear_after_s: float
    _open: dict[tuple[str, str | None], Alarm] = field(default_factory=dict)

    @property
    def open(self) -> tuple[Alarm, ...]:
        """What is wrong now, the oldest first."""
        return tuple(self._open.values())

    def report(self, condition: Condition, now: Moment) -> Iterator[Change]:
        """Take note of a condition; gives the change if it raises an alarm."""
        known = self._open.get(condition.key)
        if known is None:
            self._open[condition.key] = Alarm(condition, now.utc, now.monotonic_s)
            yield Change("raised", condition, now.utc)
        else:
            self._open[condition.key] = replace(known, condition=condition, seen_s=now.monotonic_s)

    def settle(self, now: Moment) -> Iterator[Change]:
        """Clear what has not been reported for a while."""
        for alarm in self.open:
            if now.monotonic_s - alarm.seen_s >= self.clear_after_s:
                del self._open[alarm.condition.key]
                yield Change("cleared", alarm.condition, now.utc)

    def close(self, message: str, now: Moment) -> Iterator[Change]:
        """Clear everything, and say why."""
        for alarm in self.open:
            del self._open[alarm.condition.key]
            yield Change("cleared", replace(alarm.condition, message=message), now.utc)


@dataclass(frozen=True)
class WatchLimits:
    """What the watch of a headset tolerates. Seconds are real ones unless they say `client`.

    `silent_s`: no frame while frames are wanted. `clock_unknown_s`: no usable reading of the
    clocks. `clock_uncertain_s`: half of the smallest round trip within `clock_window_s`.
    `backlog_s`: movement that is not on disk yet. `low_rate_share` of the usual frame rate, over
    `low_rate_client_s`: 72 of 90 Hz is a rate that displays have, so a little less than that.
    `gap_client_s`: shorter gaps are counted, and raise nothing. `clear_after_s`: an alarm is
    cleared after so long without its cause. `look_every_s`: how often the watch looks up.
    """

    silent_s: float = 3.0
    clock_unknown_s: float = 15.0
    clock_uncertain_s: float = 0.010
    clock_window_s: float = 60.0
    backlog_s: float = 10.0
    low_rate_share: float = 0.79
    low_rate_client_s: float = 3.0
    gap_client_s: float = 0.25
    clear_after_s: float = 3.0
    look_every_s: float = 0.5
    quality: QualityLimits = USUAL

    def at_scale(self, time_scale: float) -> "WatchLimits":
        """For a simulated session in which `time_scale` seconds of the client pass in a real one.

        A client that runs faster than life waits for the server and shares its machine: it owes
        nobody a steady stream, so it may be silent ten times as long. With one that runs slower,
        what is judged by the second of its clock comes more rarely.
        """
        if time_scale > 1.0:
            return replace(self, silent_s=10.0 * self.silent_s)
        return replace(self, clear_after_s=self.clear_after_s / time_scale)
