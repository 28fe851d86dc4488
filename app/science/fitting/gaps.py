"""What to do where markers were not seen: bridge the short gaps, keep the longest whole stretch."""

import numpy as np

from app.science.rig import BoolArray
from app.science.rotations import FloatArray

LONGEST_BRIDGE_S = 0.5


def bridged(values: FloatArray, rate_hz: float) -> tuple[FloatArray, BoolArray]:
    """Fill gaps of up to half a second by straight lines.

    Args:
        values: (N, K) with NaN rows where nothing was seen.
        rate_hz: frames a second.

    Returns:
        The values, NaN where a gap is longer or open at an end, and (N,) whether each was seen.
    """
    seen: BoolArray = np.all(np.isfinite(values), axis=-1)
    places = np.flatnonzero(seen)
    if len(places) < 2 or seen.all():
        return np.where(seen[:, None], values, np.nan), seen
    frames = np.arange(len(values))
    filled = np.stack([np.interp(frames, places, column[places]) for column in values.T], axis=-1)
    before = np.searchsorted(places, frames, side="right") - 1
    after = np.searchsorted(places, frames, side="left")
    inside = (before >= 0) & (after < len(places))
    width = places[np.minimum(after, len(places) - 1)] - places[np.maximum(before, 0)] - 1
    short = inside & (width <= LONGEST_BRIDGE_S * rate_hz)
    return np.where((seen | short)[:, None], filled, np.nan), seen


def longest_run(good: BoolArray) -> tuple[int, int]:
    """First frame and end of the longest run of good frames; (0, 0) where there is none."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], good.astype(np.int8), [0]))))
    if len(edges) == 0:
        return 0, 0
    starts, ends = edges[::2], edges[1::2]
    longest = int(np.argmax(ends - starts))
    return int(starts[longest]), int(ends[longest])
