"""Fitting the mapping to the probes of a client run."""

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
    """Map the client's clock on the server's.

    Args:
        probes: of one client run, in the order in which they were made. Probes without an answer
            tell nothing; those that cannot be true are left out and counted.
        limits: what is taken for granted about the clocks.

    Returns:
        A mapping that is good at any time, with an uncertainty for each. Without a probe it gives
        NaN and inf.
    """
    answered = probes.taken(probes.answered)
    resolution_s = reading_step_s(
        np.concatenate((answered.client_sent_s, answered.client_received_s))
    )
    widening_s = limits.slack_s + resolution_s
    possible = is_possible(answered, widening_s)
    used = answered.taken(possible)
    bounds = bounds_of(used, widening_s)
    # How many usable probes came before each impossible one.
    places = np.cumsum(possible, dtype=np.int64)[~possible]
    windows = _counted(cut_windows(bounds, limits), places)
    runs = [
        make_stretch(run, used, bounds, limits, widening_s)
        for run in stretches(windows, bounds, limits)
    ]
    return ClockMapping(place(runs, limits.step_s), resolution_s)


def _counted(windows: list[Window], places: npt.NDArray[np.int64]) -> list[Window]:
    """Count each impossible probe in the window behind it, or in the last one."""
    if not windows:
        return windows
    ends = np.array([window.index[-1] for window in windows])
    inside = np.minimum(np.searchsorted(ends, places), len(windows) - 1)
    lost = np.bincount(inside, minlength=len(windows))
    return [
        replace(window, left_out=window.left_out + int(more))
        for window, more in zip(windows, lost, strict=True)
    ]
