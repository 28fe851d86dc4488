"""Assign to each moment of a replay the nearest stored frame, except in gaps."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from app.features.record.telemetry import Frames, concatenate

GAP_S = 0.25
"""Between frames that are further apart than this is a gap, in which nothing is shown."""
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Grid:
    """A grid of `count` moments at a constant rate, from the phase's time 0."""

    rate_hz: float
    count: int

    @classmethod
    def over(cls, duration_s: float, rate_hz: float) -> "Grid":
        """Return the grid of moments from 0 to `duration_s`."""
        return cls(rate_hz, 1 + math.floor(duration_s * rate_hz + 1e-6))

    def between(self, first_s: float, last_s: float) -> Indices:
        """Return the indices of the moments from `first_s` to `last_s`, both included."""
        first = max(0, math.ceil(first_s * self.rate_hz - 1e-6))
        last = min(self.count - 1, math.floor(last_s * self.rate_hz + 1e-6))
        return np.arange(first, max(first, last + 1), dtype=np.int64)


@dataclass
class Sampling:
    """Assigns frames to the moments of a grid, from the pieces of one run in order.

    `offset_s` is added to the run's clock to get the phase's time. The first and last frame are
    also used for moments up to half a step before and after them.
    """

    grid: Grid
    offset_s: float
    gaps: list[tuple[float, float]] = field(default_factory=list)
    first_s: float | None = None
    _last: Frames | None = None

    def take(self, piece: Frames) -> tuple[Indices, Frames]:
        """Return the moments whose frame this piece determines, and the frame of each."""
        rising = self._rising(piece)
        joined = rising if self._last is None else concatenate([self._last, rising])
        if len(rising) == 0:
            return np.empty(0, np.int64), rising
        times_s = joined.times_s + self.offset_s
        half_s = 0.5 / self.grid.rate_hz
        if self.first_s is None:
            self.first_s = float(times_s[0])
        moments = self.grid.between(float(times_s[0]) - half_s, float(times_s[-1]) + half_s)
        rows = _nearest(times_s, moments / self.grid.rate_hz)
        apart_s = np.abs(times_s[rows] - moments / self.grid.rate_hz)
        wide = np.flatnonzero(np.diff(times_s) > GAP_S)
        self.gaps += [(float(times_s[at]), float(times_s[at + 1])) for at in wide]
        kept = (apart_s <= half_s) | ~_inside(moments / self.grid.rate_hz, times_s, wide)
        self._last = chosen(rising, np.array([len(rising) - 1]))
        return moments[kept], chosen(joined, rows[kept])

    @property
    def last_s(self) -> float | None:
        """Return the phase's time of the last frame so far."""
        return None if self._last is None else float(self._last.times_s[0]) + self.offset_s

    def _rising(self, piece: Frames) -> Frames:
        """Return the frames whose time is finite and later than all before."""
        before_s = -np.inf if self._last is None else float(self._last.times_s[0])
        usable = np.where(np.isfinite(piece.times_s), piece.times_s, -np.inf)
        highest = np.maximum.accumulate(np.concatenate(([before_s], usable)))[:-1]
        return chosen(piece, np.flatnonzero(usable > highest))


def chosen(frames: Frames, rows: NDArray[np.int64]) -> Frames:
    """Return the frames with these indices, in that order."""
    return Frames(frames.seq[rows], frames.times_s[rows], frames.flags[rows], frames.values[rows])


def uncovered(runs: Sequence[Sampling], duration_s: float) -> list[tuple[float, float]]:
    """Return all gaps in order: within runs, between them, before the first and after the last."""
    found = [gap for run in runs for gap in run.gaps]
    spans = [(run.first_s, run.last_s) for run in runs]
    reached_s = 0.0
    for first_s, last_s in sorted((a, b) for a, b in spans if a is not None and b is not None):
        if first_s - reached_s > GAP_S:
            found.append((reached_s, first_s))
        reached_s = max(reached_s, last_s)
    if duration_s - reached_s > GAP_S:
        found.append((reached_s, duration_s))
    return sorted((max(0.0, begin_s), end_s) for begin_s, end_s in found if end_s > 0.0)


def _nearest(times_s: NDArray[np.float64], query_s: NDArray[np.float64]) -> Indices:
    """Return the index of the nearest of the ascending times for each query."""
    middles_s = (times_s[1:] + times_s[:-1]) / 2.0
    return np.asarray(np.searchsorted(middles_s, query_s), dtype=np.int64)


def _inside(
    query_s: NDArray[np.float64], times_s: NDArray[np.float64], wide: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Return which queries lie between two frames that are too far apart."""
    after = np.searchsorted(times_s, query_s)
    return np.asarray(np.isin(after - 1, wide) & (after > 0) & (after < len(times_s)))
