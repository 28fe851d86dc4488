"""Fit the clock mapping to the clock probes of a client run."""

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from app.science.clock.mapping import ClockMapping
from app.science.clock.placing import place
from app.science.clock.probes import (
    ClockLimits,
    ClockProbes,
    bounds_of,
    is_possible,
    reading_step_s,
)
from app.science.clock.stretch import make_stretch
from app.science.clock.windows import Window, cut_windows, stretches

DEFAULT_LIMITS = ClockLimits()


def fit_clock(probes: ClockProbes, limits: ClockLimits = DEFAULT_LIMITS) -> ClockMapping:
    """Map the client's clock to the server's clock.

    Args:
        probes: the probes of one client run, in the order in which they were made. Probes without
            an answer are ignored; those that cannot be true are left out and counted.
        limits: the assumptions about the clocks.

    Returns:
        A mapping for any client time, with an uncertainty at each. Without a usable probe it gives
        NaN and inf.
    """
    answered = probes.select(probes.answered)
    resolution_s = reading_step_s(
        np.concatenate((answered.client_sent_s, answered.client_received_s))
    )
    widening_s = limits.slack_s + resolution_s
    possible = is_possible(answered, widening_s)
    used = answered.select(possible)
    bounds = bounds_of(used, widening_s)
    # The number of usable probes before each impossible one.
    positions = np.cumsum(possible, dtype=np.int64)[~possible]
    windows = _count_impossible(cut_windows(bounds, limits), positions)
    runs = [
        make_stretch(run, used, bounds, limits, widening_s)
        for run in stretches(windows, bounds, limits)
    ]
    return ClockMapping(place(runs, limits.step_s), resolution_s)


def _count_impossible(windows: list[Window], positions: npt.NDArray[np.int64]) -> list[Window]:
    """Count each impossible probe in the window that follows it, or in the last window."""
    if not windows:
        return windows
    ends = np.array([window.index[-1] for window in windows])
    following = np.minimum(np.searchsorted(ends, positions), len(windows) - 1)
    counts = np.bincount(following, minlength=len(windows))
    return [
        replace(window, left_out=window.left_out + int(count))
        for window, count in zip(windows, counts, strict=True)
    ]
