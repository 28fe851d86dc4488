"""Map client times to server times, with an error bound at every moment.

Within a client run the client's monotonic clock is taken as the reference: it may jump ahead or
stop, and is assumed to have gone back only where a probe has an earlier time than the previous
probe. Stretches follow each other in the order in which they were made; each begins where the
client time of the previous ones ended, so they never overlap, and the curve through all knots is
made non-decreasing. A later client time therefore never has an earlier server time. Durations
should still be computed from client times, which are finer.

The bound at a moment takes into account every stretch that may cover it:

- inside one stretch: all lines between the bounds of that window;
- in a gap between two stretches without a jump: the intersection of both bounds, each extrapolated
  with the drift limit;
- around a jump: the union of both bounds, because the jump may have happened at any time between
  the two stretches;
- at a time that the client's clock showed twice, because it was set back: the union of both bounds;
- before the first and after the last stretch: the bounds of that stretch, extrapolated with the
  drift limit.

A clock that bends more than the limits allow, such as a server clock that NTP slews by hundreds of
ppm, is detected once no line fits. Until then both the true and the reported offset lie between the
bounds of each probe, so near a probe the error stays below its full round trip.
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
    """One window of a clock mapping, as a table row.

    Between `client_from_s` and `client_to_s` the server's time is t + offset_s + drift (t -
    client_from_s), within `uncertainty_s` (the largest of the segment). `server_shift_s`, which
    `offset_s` includes, is the correction added to the server's readings because its clock had
    jumped. `wall_s` is the server's wall clock minus the server's time; NaN if unknown.
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
    """The server's time as a function of the client's; undefined (NaN) if there are no probes.

    `resolution_s` is the step in which the client's clock is read if it is coarse, else 0; the
    bounds include it.
    """

    placed: tuple[Placed, ...]
    resolution_s: float = 0.0

    def to_server(self, t_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the server's time and its uncertainty at client times (k,), each (k,), in s.

        The server time never decreases with client time. The true time lies within plus or minus
        the uncertainty if the clocks stayed within the limits. NaN and inf where there is no probe
        or the client time is not finite.
        """
        t_s = np.asarray(t_s, dtype=np.float64)
        server_s, uncertainty_s = np.full(t_s.shape, np.nan), np.full(t_s.shape, np.inf)
        finite = np.isfinite(t_s)
        if self.placed and finite.any():
            own = t_s[finite]
            offset_s = self._course(own)
            low, high = self._bounds(own)
            server_s[finite] = own + offset_s
            uncertainty_s[finite] = np.maximum(high - offset_s, offset_s - low)
        return server_s, uncertainty_s

    @property
    def wall_s(self) -> float:
        """The server's wall clock minus its time at the first probes, s; NaN if unknown."""
        return self.placed[0].stretch.wall_first_s if self.placed else float("nan")

    @cached_property
    def segments(self) -> tuple[ClockSegment, ...]:
        """All windows as table rows, in the order in which they were made."""
        return tuple(row for placed in self.placed for row in self._rows(placed))

    def _rows(self, placed: Placed) -> list[ClockSegment]:
        knots_s = placed.stretch.knots_s
        offsets_s = placed.offset_at(knots_s)
        rows = []
        for at, piece in enumerate(placed.stretch.pieces):
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
                    step_s=placed.step_s if at == 0 else 0.0,
                    stepped=placed.stepped if at == 0 else "",
                    server_shift_s=placed.shift_s,
                    wall_s=piece.wall_s - placed.shift_s,
                )
            )
        return rows

    def _course(self, t_s: FloatArray) -> FloatArray:
        """Return the offset at client times (k,) on the one curve through all stretches, (k,)."""
        times_s, offsets_s = self._knots
        first, last = self.placed[0], self.placed[-1]
        inside = np.clip(t_s, times_s[0], times_s[-1])
        at = np.clip(np.searchsorted(times_s, inside, side="right") - 1, 0, len(times_s) - 2)
        length_s = times_s[at + 1] - times_s[at]
        share = (inside - times_s[at]) / np.where(length_s > 0.0, length_s, 1.0)
        offset_s = offsets_s[at] + share * (offsets_s[at + 1] - offsets_s[at])
        beyond = (t_s - inside) * np.where(
            t_s < inside, first.stretch.end_drift[0], last.stretch.end_drift[1]
        )
        result: FloatArray = offset_s + beyond
        return result

    @cached_property
    def _knots(self) -> tuple[FloatArray, FloatArray]:
        """The client times and offsets of the knots of the offset curve, both (n,)."""
        times: list[FloatArray] = []
        servers: list[FloatArray] = []
        reached_s = -np.inf
        for placed in self.placed:
            own = placed.stretch.knots_s
            own = own if own[0] >= reached_s else np.append(reached_s, own[own > reached_s])
            own = own[own <= placed.stretch.knots_s[-1]]
            if len(own):
                times.append(own)
                servers.append(own + placed.offset_at(own))
                reached_s = float(own[-1])
        times_s = np.concatenate(times)
        servers_s = np.maximum.accumulate(np.concatenate(servers))
        return times_s, servers_s - times_s

    def _bounds(self, t_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        low, high = np.full(t_s.shape, np.inf), np.full(t_s.shape, -np.inf)
        for placed, mine in zip(self.placed, self._relevant_times(t_s), strict=True):
            if mine.any():
                own_low, own_high = placed.bounds_at(t_s[mine])
                low[mine] = np.minimum(low[mine], own_low)
                high[mine] = np.maximum(high[mine], own_high)
        for before, after in pairwise(self.placed):
            silent = (t_s > before.stretch.knots_s[-1]) & (t_s < after.stretch.knots_s[0])
            if not after.stepped and silent.any():
                both = [placed.bounds_at(t_s[silent]) for placed in (before, after)]
                low[silent] = np.maximum(both[0][0], both[1][0])
                high[silent] = np.minimum(both[0][1], both[1][1])
        return low, high

    def _relevant_times(self, t_s: FloatArray) -> list[npt.NDArray[np.bool_]]:
        """Return one mask (k,) for each stretch: the times at which its bounds count."""
        begins, ends = self._validity
        inside = [(t_s >= begin) & (t_s <= end) for begin, end in zip(begins, ends, strict=True)]
        outside = ~np.logical_or.reduce(inside)
        ends_before = np.where(np.less_equal.outer(ends, t_s), ends[:, np.newaxis], -np.inf)
        begins_after = np.where(np.greater_equal.outer(begins, t_s), begins[:, np.newaxis], np.inf)
        nearest_before, nearest_after = ends_before.max(axis=0), begins_after.min(axis=0)
        return [
            mine | (outside & ((end == nearest_before) | (begin == nearest_after)))
            for mine, begin, end in zip(inside, begins, ends, strict=True)
        ]

    @cached_property
    def _validity(self) -> tuple[FloatArray, FloatArray]:
        """The first and the last client time at which each stretch may be valid.

        Where the client's clock was set back, the earlier stretch may have lasted, after its last
        probe, for as long as the server counted until the next one; the later stretch may have
        begun earlier by the same time.
        """
        begins = np.array([placed.stretch.knots_s[0] for placed in self.placed])
        ends = np.array([placed.stretch.knots_s[-1] for placed in self.placed])
        servers = [
            (placed.server_at(begin), placed.server_at(end))
            for placed, begin, end in zip(self.placed, begins, ends, strict=True)
        ]
        for at in np.flatnonzero(begins[1:] < np.maximum.accumulate(ends)[:-1]) + 1:
            silent_s = max(0.0, servers[at][0] - servers[at - 1][1])
            begins[at] -= silent_s
            ends[at - 1] += silent_s
        return begins, ends
