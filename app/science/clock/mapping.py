"""From the client's time to the server's, with a bound on the error at every moment.

Within a client run the client's monotonic clock is the truth: it may jump ahead or stand still, and
is taken to go back only where a probe has an earlier time than the one before. Stretches follow
each other in the order in which they were made; each begins where the client's time of the ones
before ended, so they never overlap, and the course through all knots is made to never fall.
Therefore a later client time never has an earlier server time. Lengths should still be taken in
client time, which is finer.

The bound of a moment is taken from every stretch that could hold it:

- inside one stretch: from all lines between that window's bounds;
- in a silence between two without a jump: what both allow, each carried on with the drift limit;
- around a jump: what either allows, since it may have been anywhere between the two;
- a time that the client's clock showed twice, because it was set back: from both;
- before the first and behind the last: carried on with the drift limit.

A clock that bends more than the limits allow, as a server's that NTP slews by hundreds of ppm, is
noticed once no line is left. Until then both the truth and what is told lie between the bounds of
each probe, so near a probe the error stays below its whole round trip.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from app.science.clock.placing import Placed, Stepped
from app.science.clock.probes import FloatArray


@dataclass(frozen=True)
class ClockSegment:
    """One window of a mapping, as a row of a table.

    Between `client_from_s` and `client_to_s` the server's time is
    t + offset_s + drift (t - client_from_s), within `uncertainty_s` (the largest of the segment).
    `server_shift_s` is held in the offset: what had to be added to the server's readings because
    its clock had jumped. `wall_s`: the server's wall clock minus the server's time; NaN if unknown.
    """

    client_from_s: float
    client_to_s: float
    offset_s: float
    drift: float
    uncertainty_s: float
    min_round_trip_s: float
    probes: int
    left_out: int
    step_s: float
    stepped: Stepped
    server_shift_s: float
    wall_s: float


@dataclass(frozen=True, eq=False)
class ClockMapping:
    """The course of the server's time over the client's; without probes it knows nothing.

    `resolution_s`: the step in which the client's clock is read, if it is coarse; held in bounds.
    """

    placed: tuple[Placed, ...]
    resolution_s: float = 0.0

    def to_server(self, t_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Server's time and its uncertainty at client times (k,): ((k,), (k,)), s.

        The time never falls. The true one is within the uncertainty either way if the clocks kept
        to the limits. NaN and inf where there is no probe or the time is not finite.
        """
        t_s = np.asarray(t_s, dtype=np.float64)
        server_s, uncertainty_s = np.full(t_s.shape, np.nan), np.full(t_s.shape, np.inf)
        known = np.isfinite(t_s)
        if self.placed and known.any():
            own = t_s[known]
            offset_s = self._course(own)
            low, high = self._bounds(own)
            server_s[known] = own + offset_s
            uncertainty_s[known] = np.maximum(high - offset_s, offset_s - low)
        return server_s, uncertainty_s

    @property
    def wall_s(self) -> float:
        """The server's wall clock minus its time at the first probes, s; NaN if unknown."""
        return self.placed[0].stretch.wall_first_s if self.placed else float("nan")

    @cached_property
    def segments(self) -> tuple[ClockSegment, ...]:
        """Every window, in the order in which they were made."""
        return tuple(row for one in self.placed for row in self._rows(one))

    def _rows(self, one: Placed) -> list[ClockSegment]:
        knots_s = one.stretch.knots_s
        offsets_s = one.offset_at(knots_s)
        rows = []
        for at, piece in enumerate(one.stretch.pieces):
            begin_s, end_s = float(knots_s[at]), float(knots_s[at + 1])
            length_s = end_s - begin_s
            change_s = float(offsets_s[at + 1] - offsets_s[at])
            inner = np.array([begin_s, max(begin_s, np.nextafter(end_s, begin_s))])
            rows.append(
                ClockSegment(
                    client_from_s=begin_s,
                    client_to_s=end_s,
                    offset_s=float(offsets_s[at]),
                    drift=change_s / length_s if length_s > 0.0 else 0.0,
                    uncertainty_s=float(self.to_server(inner)[1].max()),
                    min_round_trip_s=piece.min_round_trip_s,
                    probes=piece.probes,
                    left_out=piece.left_out,
                    step_s=one.step_s if at == 0 else 0.0,
                    stepped=one.stepped if at == 0 else "",
                    server_shift_s=one.shift_s,
                    wall_s=piece.wall_s - one.shift_s,
                )
            )
        return rows

    def _course(self, t_s: FloatArray) -> FloatArray:
        """The offset on the one course through all stretches, (k,)."""
        times_s, offsets_s = self._knots
        first, last = self.placed[0], self.placed[-1]
        inside = np.clip(t_s, times_s[0], times_s[-1])
        at = np.clip(np.searchsorted(times_s, inside, side="right") - 1, 0, len(times_s) - 2)
        length_s = times_s[at + 1] - times_s[at]
        share = (inside - times_s[at]) / np.where(length_s > 0.0, length_s, 1.0)
        offset_s = offsets_s[at] + share * (offsets_s[at + 1] - offsets_s[at])
        before = (t_s - inside) * np.where(
            t_s < inside, first.stretch.end_drift[0], last.stretch.end_drift[1]
        )
        result: FloatArray = offset_s + before
        return result

    @cached_property
    def _knots(self) -> tuple[FloatArray, FloatArray]:
        """Client's times and offsets of the course, both (n,)."""
        times: list[FloatArray] = []
        servers: list[FloatArray] = []
        reached_s = -np.inf
        for one in self.placed:
            own = one.stretch.knots_s
            own = own if own[0] >= reached_s else np.append(reached_s, own[own > reached_s])
            own = own[own <= one.stretch.knots_s[-1]]
            if len(own):
                times.append(own)
                servers.append(own + one.offset_at(own))
                reached_s = float(own[-1])
        times_s = np.concatenate(times)
        servers_s = np.maximum.accumulate(np.concatenate(servers))
        return times_s, servers_s - times_s

    def _bounds(self, t_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        low, high = np.full(t_s.shape, np.inf), np.full(t_s.shape, -np.inf)
        for one, mine in zip(self.placed, self._could_hold(t_s), strict=True):
            if mine.any():
                own_low, own_high = one.bounds_at(t_s[mine])
                low[mine] = np.minimum(low[mine], own_low)
                high[mine] = np.maximum(high[mine], own_high)
        for before, after in pairwise(self.placed):
            silent = (t_s > before.stretch.knots_s[-1]) & (t_s < after.stretch.knots_s[0])
            if not after.stepped and silent.any():
                both = [one.bounds_at(t_s[silent]) for one in (before, after)]
                low[silent] = np.maximum(both[0][0], both[1][0])
                high[silent] = np.minimum(both[0][1], both[1][1])
        return low, high

    def _could_hold(self, t_s: FloatArray) -> list[npt.NDArray[np.bool_]]:
        """For each stretch at which of the times (k,) it counts."""
        begins, ends = self._reach
        inside = [(t_s >= begin) & (t_s <= end) for begin, end in zip(begins, ends, strict=True)]
        outside = ~np.logical_or.reduce(inside)
        before = np.where(np.less_equal.outer(ends, t_s), ends[:, np.newaxis], -np.inf)
        behind = np.where(np.greater_equal.outer(begins, t_s), begins[:, np.newaxis], np.inf)
        nearest_before, nearest_behind = before.max(axis=0), behind.min(axis=0)
        return [
            mine | (outside & ((end == nearest_before) | (begin == nearest_behind)))
            for mine, begin, end in zip(inside, begins, ends, strict=True)
        ]

    @cached_property
    def _reach(self) -> tuple[FloatArray, FloatArray]:
        """From where to where in client's time each stretch can hold.

        Where the client's clock was set back, the one stretch may have gone on for as long after
        its last probe as the server counted until the next one, and the other begun as early.
        """
        begins = np.array([one.stretch.knots_s[0] for one in self.placed])
        ends = np.array([one.stretch.knots_s[-1] for one in self.placed])
        servers = [
            (one.server_at(begin), one.server_at(end))
            for one, begin, end in zip(self.placed, begins, ends, strict=True)
        ]
        for at in np.flatnonzero(begins[1:] < np.maximum.accumulate(ends)[:-1]) + 1:
            silent_s = max(0.0, servers[at][0] - servers[at - 1][1])
            begins[at] -= silent_s
            ends[at - 1] += silent_s
        return begins, ends
