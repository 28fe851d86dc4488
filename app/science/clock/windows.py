"""Cut probes into windows that a single line fits, leaving out single impossible probes.

A window grows probe by probe while some line still lies between all bounds, up to the longest
window that the limits allow. Where no line is left there are two explanations. Either that one
probe is wrong: then the probes after it fit again, and it alone is left out. Or a clock jumped,
stopped or changed its rate: then those probes do not fit, and the next window begins.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from app.science.clock.band import Band, band_of
from app.science.clock.probes import Bounds, ClockError, ClockLimits, FloatArray

Index = npt.NDArray[np.intp]
_AGREEING = 2


@dataclass(frozen=True, eq=False)
class Window:
    """Indices of probes that one line fits, the band of such lines, and how many were left out."""

    index: Index
    band: Band
    left_out: int = 0


def cut_windows(bounds: Bounds, limits: ClockLimits) -> list[Window]:
    """Return all windows of the probes, in order; single probes that fit no line are left out."""
    windows: list[Window] = []
    first, count = 0, len(bounds.upper_t_s)
    while first < count:
        window, first = _longest(bounds, first, limits)
        windows.append(window)
    return _drop_isolated_probes(windows, bounds, limits)


def stretches(windows: Sequence[Window], bounds: Bounds, limits: ClockLimits) -> list[list[Window]]:
    """Group windows into runs without a jump or a long gap between them."""
    runs: list[list[Window]] = []
    for window in windows:
        if runs and _joins_on(runs[-1][-1], window, bounds, limits):
            runs[-1].append(window)
        else:
            runs.append([window])
    return runs


def boundary_s(before: Window, after: Window, bounds: Bounds) -> float:
    """Return the client time half-way between a window's last probe and the next window's first."""
    sent_s = bounds.upper_t_s
    return 0.5 * float(sent_s[before.index[-1]] + sent_s[after.index[0]])


def _joins_on(before: Window, after: Window, bounds: Bounds, limits: ClockLimits) -> bool:
    sent_s = bounds.upper_t_s
    gap_s = float(sent_s[after.index[0]] - sent_s[before.index[-1]])
    if not 0.0 < gap_s <= limits.window_s:
        return False
    at = np.array([boundary_s(before, after, bounds)])
    (low, high), (next_low, next_high) = before.band.at(at), after.band.at(at)
    return bool(low[0] <= next_high[0] and next_low[0] <= high[0])


def _longest(bounds: Bounds, first: int, limits: ClockLimits) -> tuple[Window, int]:
    """Return the longest window that starts at probe `first`, and where the next one begins."""
    index = _within(bounds.upper_t_s, first, limits.window_s)
    end, left_out = first + len(index), 0
    while True:
        count, band = _fitting(bounds, index, limits.drift)
        if count == len(index):
            return Window(index, band, left_out), end
        blocked = int(index[count])
        following = np.arange(blocked + 1, min(blocked + 1 + _AGREEING, len(bounds.upper_t_s)))
        without_it = np.concatenate((index[:count], following))
        if len(following) == 0 or band_of(bounds.select(without_it), limits.drift) is None:
            return Window(index[:count], band, left_out), blocked
        index, left_out = np.delete(index, count), left_out + 1


def _within(sent_s: FloatArray, first: int, window_s: float) -> Index:
    """Return the indices of the probes from `first` on, up to the first one over a window away."""
    away = np.flatnonzero(np.abs(sent_s[first:] - sent_s[first]) > window_s)
    end = first + int(away[0]) if len(away) else len(sent_s)
    return np.arange(first, end)


def _fitting(bounds: Bounds, index: Index, drift: float) -> tuple[int, Band]:
    """Return how many of the first probes have a line in common, and the band of these lines.

    Additional bounds never allow additional lines, so bisection finds the number.
    """
    band = band_of(bounds.select(index), drift)
    if band is not None:
        return len(index), band
    fits, too_many = 1, len(index)
    best = band_of(bounds.select(index[:1]), drift)
    if best is None:
        raise ClockError(f"Probe {index[0]} contradicts itself: leave impossible probes out first.")
    while too_many - fits > 1:
        middle = (fits + too_many) // 2
        band = band_of(bounds.select(index[:middle]), drift)
        if band is None:
            too_many = middle
        else:
            fits, best = middle, band
    return fits, best


def _drop_isolated_probes(
    windows: Sequence[Window], bounds: Bounds, limits: ClockLimits
) -> list[Window]:
    """Leave out each probe that agrees with neither neighbour, unless no two probes agree."""
    runs = stretches(windows, bounds, limits)
    sizes = [sum(len(window.index) for window in run) for run in runs]
    if max(sizes, default=0) < 2:
        return list(windows)
    kept: list[Window] = []
    waiting = 0
    for run, size in zip(runs, sizes, strict=True):
        lost = sum(window.left_out for window in run)
        if size == 1:
            waiting += 1 + lost
            continue
        kept += [replace(run[0], left_out=run[0].left_out + waiting), *run[1:]]
        waiting = 0
    kept[-1] = replace(kept[-1], left_out=kept[-1].left_out + waiting)
    return kept
