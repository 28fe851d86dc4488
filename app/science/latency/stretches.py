"""Stretches of active time on a regular grid, divided into blocks, as the units of comparison."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.science.latency.smoothing import BoolArray, Track
from app.science.rotations import FloatArray

GRID_S = 1.0 / 90.0
_LONGEST_STRETCH_S = 60.0  # bounds memory; does not change the result
_BLOCK_S = 2.0


@dataclass(frozen=True, eq=False)
class Stretch:
    """Up to a minute of a client run, prepared for comparing its two streams.

    Attributes:
        target, actual: both streams of the run, on one clock.
        grid_s: (k,) regular times from the first to the last active actual frame.
        active: (k,) mask of the grid times that are in active time.
    """

    target: Track
    actual: Track
    grid_s: FloatArray
    active: BoolArray

    @property
    def at_s(self) -> FloatArray:
        """The grid times that are in active time."""
        return self.grid_s[self.active]

    @property
    def block_starts(self) -> npt.NDArray[np.intp]:
        """The index in `at_s` at which each block of about two seconds begins."""
        number = np.floor((self.at_s - self.grid_s[0]) / _BLOCK_S)
        return np.flatnonzero(np.diff(number, prepend=-1.0))


def stretches(runs: Sequence[tuple[Track, Track]]) -> Iterator[Stretch]:
    """Cut each client run's (target, actual) tracks into stretches that contain active time."""
    for target, actual in runs:
        times = actual.times_s[actual.active]
        if times.size < 2 or target.times_s.size < 2:
            continue
        start_s = float(times[0])
        while start_s < times[-1]:
            end_s = min(start_s + _LONGEST_STRETCH_S, float(times[-1]))
            grid_s = np.arange(start_s, end_s, GRID_S)
            active = _active_at(actual, grid_s)
            if active.any():
                yield Stretch(target, actual, grid_s, active)
            # Continue at the next active frame, however long the pause before it was.
            later = times[np.searchsorted(times, end_s, side="right") :]
            start_s = float(later[0]) if later.size else end_s


def _active_at(track: Track, at_s: FloatArray) -> BoolArray:
    """Return whether the frames before and after each time are both active."""
    last = len(track.times_s) - 1
    low = np.clip(np.searchsorted(track.times_s, at_s, side="right") - 1, 0, last)
    high = np.clip(np.searchsorted(track.times_s, at_s, side="left"), 0, last)
    result: BoolArray = track.active[low] & track.active[high]
    return result
