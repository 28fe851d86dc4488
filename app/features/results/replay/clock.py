"""The times of a phase: every client run's clock on one axis, and where the active time ran on it.

Each run of the headset's program has a clock of its own. The phase's time begins where the phase's
clock first ran, and counts on in seconds of the headset's clock. What a later run recorded is put
behind the first by the wall clock: by the comparisons of clocks where there are any, else by when
the run's first message of the phase came.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import NamedTuple


@dataclass(frozen=True)
class Stretch:
    """A stretch in which the active time ran: (begin, end) on the phase's time and on its own."""

    begin_s: float
    end_s: float
    begin_active_s: float
    end_active_s: float


@dataclass(frozen=True)
class Run:
    """A client run in the phase, on the phase's time; `begin_utc` None where nothing tells it."""

    epoch: int
    begin_s: float
    end_s: float
    begin_utc: datetime | None
    uncertainty_ms: float | None


MOST_UNEVEN = timedelta(seconds=5)


class Wall(NamedTuple):
    """A moment by the server's clock and how well it is known; None where it is not."""

    utc: datetime | None
    uncertainty_ms: float | None = None

    def no_later_than(self, latest: datetime) -> "Wall":
        """The same where it can be true, else the latest: nothing is heard before it happened.

        A headset's clock that ran unevenly between two comparisons is off by more than these tell;
        by how much this shows is added to the uncertainty. Off by more than MOST_UNEVEN, it is the
        server's wall clock that was set, which the comparisons have seen and `latest` has not.
        """
        known = timedelta(milliseconds=self.uncertainty_ms or 0.0)
        if self.utc is None or not known < self.utc - latest <= MOST_UNEVEN:
            return self
        return Wall(latest, (self.utc - latest + known) / timedelta(milliseconds=1))


@dataclass(frozen=True)
class Told:
    """What a run said the phase's clock did, at a time of that run's clock."""

    epoch: int
    what: str
    client_s: float
    active_s: float
    cause: str


@dataclass(frozen=True)
class PhaseClock:
    """Leads from every other time to the phase's.

    `offsets_s`: by epoch, what a run's clock lacks of the phase's time.
    """

    offsets_s: Mapping[int, float]
    runs: tuple[Run, ...]
    active: tuple[Stretch, ...]
    time_scale: float

    @property
    def duration_s(self) -> float:
        """When the last thing was recorded."""
        ends = [run.end_s for run in self.runs] + [one.end_s for one in self.active]
        return max([0.0, *ends])

    def of_counted(self, active_s: float, epoch: int, client_s: float) -> float:
        """When something was counted at `active_s`, which a run saw at its own `client_s`.

        Where the active time stood at that value for a while, the run's clock tells when in it.
        """
        first, last = (self.of_active(active_s, later=later) for later in (False, True))
        offset_s = self.offsets_s.get(epoch)
        if offset_s is None:
            return first
        return min((first, last), key=lambda t_s: abs(t_s - client_s - offset_s))

    def of_active(self, active_s: float, *, later: bool) -> float:
        """When the active time showed `active_s`; `later`: after the pause at that time, if any.

        Times beyond the last stretch are its end.
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
        """When it was then, if a run knows; between two runs as far behind the earlier one."""
        known = [run for run in self.runs if run.begin_utc is not None]
        found = None
        for run in known:
            since_s = (moment - (run.begin_utc or moment)).total_seconds() * self.time_scale
            if found is None or since_s >= 0.0:
                found = run.begin_s + since_s
        return found


_SAME_S = 1e-6


def stretches(
    told: Sequence[Told], offsets_s: Mapping[int, float], active_s: float
) -> tuple[Stretch, ...]:
    """The stretches between what started and what stopped the clock.

    A run that ended without a word left the clock where the next one took it up; the last one where
    the phase's own count `active_s` stands.
    """
    found: list[Stretch] = []
    begun: tuple[float, float] | None = None

    def close(end_active_s: float) -> None:
        if begun is not None:
            begin_s, begin_active_s = begun
            end_active_s = max(end_active_s, begin_active_s)
            end_s = begin_s + end_active_s - begin_active_s
            found.append(Stretch(begin_s, end_s, begin_active_s, end_active_s))

    for one in told:
        close(one.active_s)
        begins = one.what in BEGINNINGS
        begun = (one.client_s + offsets_s[one.epoch], one.active_s) if begins else None
    close(active_s)
    return tuple(found)


BEGINNINGS = frozenset({"started", "resumed", "walk_back_ended"})
"""What sets the phase's clock going."""


def later_by(begin: datetime, run_s: float, time_scale: float) -> datetime:
    """The moment that is so many seconds of the headset's clock behind another."""
    return begin + timedelta(seconds=run_s / time_scale)
