"""A time without a jump: windows whose lines are joined to one unbroken course of the offset."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from app.science.clock.band import Band, best_line
from app.science.clock.probes import Bounds, ClockLimits, ClockProbes, FloatArray
from app.science.clock.windows import Window, boundary_s

_WALL_READINGS = 16


@dataclass(frozen=True, eq=False)
class Piece:
    """One window of a stretch: what it rests on. `wall_s` is the server's wall clock minus its
    monotonic clock, the smallest reading; NaN if there is none."""

    band: Band
    min_round_trip_s: float
    probes: int
    left_out: int
    wall_s: float


@dataclass(frozen=True, eq=False)
class Stretch:
    """w pieces between w + 1 knots. At the knots the offset is the mean of the lines on both sides.

    Attributes:
        knots_s: (w + 1,) client's time, ascending.
        offsets_s: (w + 1,) server minus client at the knots, as the server's clock was read.
        end_drift: (before the first knot, behind the last) s/s.
        server_first_s, server_last_s: readings of the server's clock at both ends.
        wall_first_s, wall_last_s: as `Piece.wall_s`, over the probes nearest to both ends.
        slack_s, drift: as the limits say, the slack with the step in which the clock is read.
    """

    knots_s: FloatArray
    offsets_s: FloatArray
    end_drift: tuple[float, float]
    pieces: tuple[Piece, ...]
    server_first_s: float
    server_last_s: float
    wall_first_s: float
    wall_last_s: float
    slack_s: float
    drift: float

    def offset_at(self, t_s: FloatArray) -> FloatArray:
        """Server minus client (k,); beyond the ends the last drift goes on."""
        inside = np.interp(t_s, self.knots_s, self.offsets_s)
        before = np.minimum(t_s - self.knots_s[0], 0.0) * self.end_drift[0]
        behind = np.maximum(t_s - self.knots_s[-1], 0.0) * self.end_drift[1]
        offset: FloatArray = inside + before + behind
        return offset

    def bounds_at(self, t_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What the offset can be at most and at least; beyond the ends it grows with the drift."""
        at_s = np.clip(t_s, self.knots_s[0], self.knots_s[-1])
        which = np.searchsorted(self.knots_s[1:-1], at_s, side="right")
        low, high = np.empty(len(t_s)), np.empty(len(t_s))
        for number in np.unique(which):
            mine = which == number
            low[mine], high[mine] = self.pieces[number].band.at(at_s[mine])
        growth = self.slack_s + self.drift * np.abs(t_s - at_s)
        return low - growth, high + growth


def make_stretch(
    windows: Sequence[Window],
    probes: ClockProbes,
    bounds: Bounds,
    limits: ClockLimits,
    slack_s: float,
) -> Stretch:
    """Join windows that join on. `probes` and `bounds` are all of the clock's, by place."""
    pieces, lines = [], []
    for window in windows:
        own = probes.taken(window.index)
        pieces.append(_piece(window, own))
        offset_s, drift = best_line(own, window.band, limits)
        lines.append((window.band.ref_s, offset_s, drift))
    first, last = int(windows[0].index[0]), int(windows[-1].index[-1])
    inner = [boundary_s(*pair, bounds) for pair in pairwise(windows)]
    knots_s = np.array([probes.client_sent_s[first], *inner, probes.client_received_s[last]])
    index = np.concatenate([window.index for window in windows])
    return Stretch(
        knots_s=knots_s,
        offsets_s=_at_knots(knots_s, lines),
        end_drift=(lines[0][2], lines[-1][2]),
        pieces=tuple(pieces),
        server_first_s=float(probes.server_received_s[first]),
        server_last_s=float(probes.server_sent_s[last]),
        wall_first_s=_wall_s(probes.taken(index[:_WALL_READINGS])),
        wall_last_s=_wall_s(probes.taken(index[-_WALL_READINGS:])),
        slack_s=slack_s,
        drift=limits.drift,
    )


def _piece(window: Window, own: ClockProbes) -> Piece:
    shortest_s = max(0.0, float(own.round_trip_s.min()))
    return Piece(window.band, shortest_s, len(own), window.left_out, _wall_s(own))


def _at_knots(knots_s: FloatArray, lines: Sequence[tuple[float, float, float]]) -> FloatArray:
    """(w + 1,) the lines' values at the knots, the mean of two where two meet."""
    begins = [offset + drift * (knots_s[at] - ref) for at, (ref, offset, drift) in enumerate(lines)]
    ends = [
        offset + drift * (knots_s[at + 1] - ref) for at, (ref, offset, drift) in enumerate(lines)
    ]
    return np.array(
        [begins[0], *(0.5 * (a + b) for a, b in zip(ends, begins[1:], strict=False)), ends[-1]]
    )


def _wall_s(probes: ClockProbes) -> float:
    """Wall clock minus monotonic clock. It is read late, never early: the smallest is nearest."""
    if probes.server_utc_s is None:
        return float("nan")
    differences = probes.server_utc_s - probes.server_sent_s
    known = differences[np.isfinite(differences)]
    return float(known.min()) if len(known) else float("nan")
