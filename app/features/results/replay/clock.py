"""Map the clocks of all client runs of a phase to one time axis, with the spans of active time.

Each run of the headset's program has a clock of its own. The phase's time begins when the phase's
clock first ran, and continues in seconds of the headset's clock. A later run is placed by the
wall clock: by the clock probes if there are any, else by the arrival of the run's first message of
the phase.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import NamedTuple


@dataclass(frozen=True)
class Stretch:
    """A span in which the active time ran: its ends in the phase's time and in active time."""

    begin_s: float
    end_s: float
    begin_active_s: float
    end_active_s: float


@dataclass(frozen=True)
class Run:
    """A client run in the phase, in the phase's time; `begin_utc` is None where it is unknown."""

    epoch: int
    begin_s: float
    end_s: float
    begin_utc: datetime | None
    uncertainty_ms: float | None


MAX_CLOCK_ERROR = timedelta(seconds=5)


class Wall(NamedTuple):
    """A moment by the server's clock, with its uncertainty; None where it is unknown."""

    utc: datetime | None
    uncertainty_ms: float | None = None

    def no_later_than(self, latest: datetime) -> "Wall":
        """Return the moment, or `latest` if it is later: no message precedes its event.

        If a headset's clock ran unevenly between two probes, the error is larger than the probes
        show; the excess over `latest` is added to the uncertainty. An excess over MAX_CLOCK_ERROR
        means that the server's wall clock was set, which the probes account for and `latest` does
        not.
        """
        uncertainty = timedelta(milliseconds=self.uncertainty_ms or 0.0)
        if self.utc is None or not uncertainty < self.utc - latest <= MAX_CLOCK_ERROR:
            return self
        return Wall(latest, (self.utc - latest + uncertainty) / timedelta(milliseconds=1))


@dataclass(frozen=True)
class ClockReport:
    """A change of the phase's clock that a run reported, at a time of that run's clock."""

    epoch: int
    what: str
    client_s: float
    active_s: float
    cause: str


@dataclass(frozen=True)
class PhaseClock:
    """Conversions from active time, client time and UTC to the phase's time.

    `offsets_s`: by epoch, the difference from the run's clock to the phase's time.
    """

    offsets_s: Mapping[int, float]
    runs: tuple[Run, ...]
    active: tuple[Stretch, ...]
    time_scale: float

    @property
    def duration_s(self) -> float:
        """Return the phase's time of the last record."""
        ends = [run.end_s for run in self.runs] + [one.end_s for one in self.active]
        return max([0.0, *ends])

    def of_counted(self, active_s: float, epoch: int, client_s: float) -> float:
        """Return the phase's time of an event at `active_s`, recorded at the run's `client_s`.

        If the active time stood at that value for a while, the run's clock decides on the moment.
        """
        first, last = (self.of_active(active_s, later=later) for later in (False, True))
        offset_s = self.offsets_s.get(epoch)
        if offset_s is None:
            return first
        return min((first, last), key=lambda t_s: abs(t_s - client_s - offset_s))

    def of_active(self, active_s: float, *, later: bool) -> float:
        """Return the phase's time of an active time; `later`: after a pause at that time.

        Times beyond the last stretch become its end.
        """
        found = 0.0
        for one in self.active:
            if active_s < one.begin_active_s - _SAME_S:
                break
            inside_s = min(max(active_s, one.begin_active_s), one.end_active_s)
            reached = active_s <= one.end_active_s + _SAME_S
            found = one.begin_s + inside_s - one.begin_active_s
            if reached and not (later and active_s >= one.end_active_s - _SAME_S):
                break
        return found

    def of_utc(self, moment: datetime) -> float | None:
        """Return the phase's time of a moment in UTC, or None if the UTC of no run is known.

        Between two runs, the earlier run's clock is continued.
        """
        placed_runs = [run for run in self.runs if run.begin_utc is not None]
        found = None
        for run in placed_runs:
            since_s = (moment - (run.begin_utc or moment)).total_seconds() * self.time_scale
            if found is None or since_s >= 0.0:
                found = run.begin_s + since_s
        return found


_SAME_S = 1e-6


def stretches(
    reports: Sequence[ClockReport], offsets_s: Mapping[int, float], active_s: float
) -> tuple[Stretch, ...]:
    """Return the spans of active time from the reported starts and stops of the clock.

    If a run ended without a report, its span ends at the active time at which the next run
    continued; the last span ends at the phase's own count `active_s`.
    """
    found: list[Stretch] = []
    running_from: tuple[float, float] | None = None

    def close(end_active_s: float) -> None:
        if running_from is not None:
            begin_s, begin_active_s = running_from
            end_active_s = max(end_active_s, begin_active_s)
            end_s = begin_s + end_active_s - begin_active_s
            found.append(Stretch(begin_s, end_s, begin_active_s, end_active_s))

    for one in reports:
        close(one.active_s)
        begins = one.what in BEGINNINGS
        running_from = (one.client_s + offsets_s[one.epoch], one.active_s) if begins else None
    close(active_s)
    return tuple(found)


BEGINNINGS = frozenset({"started", "resumed", "walk_back_ended"})
"""The events that start the phase's clock."""


def later_by(begin: datetime, run_s: float, time_scale: float) -> datetime:
    """Return the moment that is `run_s` seconds of the headset's clock after another."""
    return begin + timedelta(seconds=run_s / time_scale)
