"""Cutting probes into windows that one line serves, with single impossible probes left out.

A window grows probe by probe while some line still lies between all bounds, and no longer than the
limit. Where no line is left there are two explanations. Either that one probe is wrong: then the
ones behind it fit again, and it alone is left out. Or a clock jumped, stood still or changed its
rate: then they do not, and the next window begins.
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
    """Probes (by place) that lines fit, those lines, and how many probes were left out here."""

    index: Index
    band: Band
    left_out: int = 0


def cut_windows(bounds: Bounds, limits: ClockLimits) -> list[Window]:
    """All windows of the probes, in their order; single probes that fit nothing are left out."""
    windows: list[Window] = []
    first, count = 0, len(bounds.upper_t_s)
    while first < count:
        window, first = _longest(bounds, first, limits)
        windows.append(window)
    return _without_loners(windows, bounds, limits)


def stretches(windows: Sequence[Window], bounds: Bounds, limits: ClockLimits) -> list[list[Window]]:
    """Runs of windows that join on: no jump between them and no long gap."""
    runs: list[list[Window]] = []
    for window in windows:
        if runs and _joins_on(runs[-1][-1], window, bounds, limits):
            runs[-1].append(window)
        else:
            runs.append([window])
    return runs


def boundary_s(before: Window, after: Window, bounds: Bounds) -> float:
    """Half-way between the last probe of a window and the first of the next, client's time."""
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
    """The longest window from `first` on, and where the next one begins."""
    kept = _within(bounds.upper_t_s, first, limits.window_s)
    end, left_out = first + len(kept), 0
    while True:
        count, band = _fitting(bounds, kept, limits.drift)
        if count == len(kept):
            return Window(kept, band, left_out), end
        blocked = int(kept[count])
        behind = np.arange(blocked + 1, min(blocked + 1 + _AGREEING, len(bounds.upper_t_s)))
        on = np.concatenate((kept[:count], behind))
        if len(behind) == 0 or band_of(bounds.chosen(on), limits.drift) is None:
            return Window(kept[:count], band, left_out), blocked
        kept, left_out = np.delete(kept, count), left_out + 1


def _within(sent_s: FloatArray, first: int, window_s: float) -> Index:
    """The probes from `first` on up to the first that is more than a window away."""
    away = np.flatnonzero(np.abs(sent_s[first:] - sent_s[first]) > window_s)
    end = first + int(away[0]) if len(away) else len(sent_s)
    return np.arange(first, end)


def _fitting(bounds: Bounds, index: Index, drift: float) -> tuple[int, Band]:
    """How many probes from the front have a line in common, and their band.

    More bounds never allow more lines, so halving finds it.
    """
    band = band_of(bounds.chosen(index), drift)
    if band is not None:
        return len(index), band
    fits, too_many = 1, len(index)
    best = band_of(bounds.chosen(index[:1]), drift)
    if best is None:
        raise ClockError(f"Probe {index[0]} contradicts itself: leave impossible probes out first.")
    while too_many - fits > 1:
        middle = (fits + too_many) // 2
        band = band_of(bounds.chosen(index[:middle]), drift)
        if band is None:
            too_many = middle
        else:
            fits, best = middle, band
    return fits, best


def _without_loners(windows: Sequence[Window], bounds: Bounds, limits: ClockLimits) -> list[Window]:
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
