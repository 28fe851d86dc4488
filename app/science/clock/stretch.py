"""A period without a clock jump: windows whose lines are joined to one continuous offset curve."""

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
    """One window of a stretch, and the probes it is based on.

    `wall_s` is the server's wall clock minus its monotonic clock, the smallest difference of the
    probes; NaN if there is none.
    """

    band: Band
    min_round_trip_s: float
    probes: int
    left_out: int
    wall_s: float


@dataclass(frozen=True, eq=False)
class Stretch:
    """A continuous piecewise linear offset: w pieces between w + 1 knots.

    At an inner knot the offset is the mean of the lines on both sides.

    Attributes:
        knots_s: (w + 1,) client's time, ascending.
        offsets_s: (w + 1,) server minus client at the knots, as the server's clock was read.
        end_drift: drift before the first knot and after the last one, s/s.
        server_first_s, server_last_s: readings of the server's clock at both ends.
        wall_first_s, wall_last_s: the same difference as `Piece.wall_s`, over the probes nearest to
            each end.
        slack_s: the slack of the limits plus the step in which the client's clock is read.
        drift: the drift limit.
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
        """Return server minus client at times (k,), (k,).

        Beyond the first and last knot the drift at that end continues.
        """
        inside = np.interp(t_s, self.knots_s, self.offsets_s)
        below = np.minimum(t_s - self.knots_s[0], 0.0) * self.end_drift[0]
        above = np.maximum(t_s - self.knots_s[-1], 0.0) * self.end_drift[1]
        offset: FloatArray = inside + below + above
        return offset

    def bounds_at(self, t_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the lowest and highest possible offset at times (k,), each (k,).

        Beyond the first and last knot the bounds widen with the drift limit.
        """
        at_s = np.clip(t_s, self.knots_s[0], self.knots_s[-1])
        which = np.searchsorted(self.knots_s[1:-1], at_s, side="right")
        low, high = np.empty(len(t_s)), np.empty(len(t_s))
        for piece in np.unique(which):
            in_piece = which == piece
            low[in_piece], high[in_piece] = self.pieces[piece].band.at(at_s[in_piece])
        growth = self.slack_s + self.drift * np.abs(t_s - at_s)
        return low - growth, high + growth


def make_stretch(
    windows: Sequence[Window],
    probes: ClockProbes,
    bounds: Bounds,
    limits: ClockLimits,
    slack_s: float,
) -> Stretch:
    """Join adjacent windows that have no jump between them into a stretch.

    `probes` and `bounds` are those of the whole client run; the windows refer to them by index.
    """
    pieces, lines = [], []
    for window in windows:
        own = probes.select(window.index)
        pieces.append(_make_piece(window, own))
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
        wall_first_s=_wall_s(probes.select(index[:_WALL_READINGS])),
        wall_last_s=_wall_s(probes.select(index[-_WALL_READINGS:])),
        slack_s=slack_s,
        drift=limits.drift,
    )


def _make_piece(window: Window, own: ClockProbes) -> Piece:
    shortest_s = max(0.0, float(own.round_trip_s.min()))
    return Piece(window.band, shortest_s, len(own), window.left_out, _wall_s(own))


def _at_knots(knots_s: FloatArray, lines: Sequence[tuple[float, float, float]]) -> FloatArray:
    """Return the lines' values at the knots, (w + 1,); the mean of two lines where two meet."""
    begins = [offset + drift * (knots_s[at] - ref) for at, (ref, offset, drift) in enumerate(lines)]
    ends = [
        offset + drift * (knots_s[at + 1] - ref) for at, (ref, offset, drift) in enumerate(lines)
    ]
    return np.array(
        [begins[0], *(0.5 * (a + b) for a, b in zip(ends, begins[1:], strict=False)), ends[-1]]
    )


def _wall_s(probes: ClockProbes) -> float:
    """Return the server's wall clock minus its monotonic clock; NaN if the wall clock is unknown.

    The wall clock is read late, never early, so the smallest difference is the most accurate.
    """
    if probes.server_utc_s is None:
        return float("nan")
    differences = probes.server_utc_s - probes.server_sent_s
    known = differences[np.isfinite(differences)]
    return float(known.min()) if len(known) else float("nan")
