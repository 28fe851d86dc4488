"""Rigid bodies at a constant rate, as a rig's movement needs; trackers' loggers seldom keep one.

Where markers were not seen, short gaps are bridged and the longest whole stretch is kept.
"""

from dataclasses import dataclass

import numpy as np

from app.science.fitting.frames import frame
from app.science.fitting.model import FitError
from app.science.rig import BodyMotion, BoolArray
from app.science.rotations import FloatArray, rotate

_STEADY = 0.05
_MOST_SAMPLES = 4


@dataclass(frozen=True, eq=False)
class Body:
    """A body at a constant rate, short gaps bridged: (N, 3), (N, 3, 3) its axes in the world."""

    places: FloatArray
    axes: FloatArray
    seen: BoolArray


def bodies_at_constant_rate(
    motion: BodyMotion, chosen: dict[str, str]
) -> tuple[float, dict[str, Body]]:
    """Return the rate in Hz and the chosen bodies by role (role -> name).

    Steps that differ by more than a twentieth from their median are evened out by straight lines.

    Raises:
        FitError: times stand still, or leap so far that most samples would be made up.
    """
    steps = np.diff(motion.times_s)
    if len(steps) < 1 or not np.isfinite(steps).all() or not (steps > 0.0).all():
        raise FitError("The times of the bodies do not rise from sample to sample.")
    rate_hz = motion.rate_hz
    columns = {role: _column(motion, name) for role, name in chosen.items()}
    if np.abs(steps * rate_hz - 1.0).max() > _STEADY:
        count = round(float(motion.times_s[-1] - motion.times_s[0]) * rate_hz) + 1
        if count > _MOST_SAMPLES * motion.frame_count:
            raise FitError("Most of the recording is missing: cut it where the times leap.")
        times = motion.times_s[0] + np.arange(count) / rate_hz
        columns = {role: _at(times, motion.times_s, values) for role, values in columns.items()}
    return rate_hz, {role: _bridged(values, rate_hz) for role, values in columns.items()}


def _column(motion: BodyMotion, name: str) -> FloatArray:
    """Place, x axis and y axis of a body, (N, 9): straight lines between axes stay near axes."""
    body = motion.names.index(name)
    rotations = motion.rotations[:, body]
    x, y = (rotate(rotations, np.array(axis)) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    return np.concatenate((motion.positions_m[:, body], x, y), axis=-1)


def _at(times: FloatArray, told: FloatArray, values: FloatArray) -> FloatArray:
    """Values at even times; unseen between samples further apart than a bridge reaches."""
    after = np.clip(np.searchsorted(told, times), 1, len(told) - 1)
    span = told[after] - told[after - 1]
    share = ((times - told[after - 1]) / span)[:, None]
    out = (1.0 - share) * values[after - 1] + share * values[after]
    exact = np.where(share <= 0.0, values[after - 1], np.where(share >= 1.0, values[after], out))
    filled: FloatArray = np.where((span <= LONGEST_BRIDGE_S)[:, None], exact, np.nan)
    return filled


def _bridged(values: FloatArray, rate_hz: float) -> Body:
    filled, seen = bridged(values, rate_hz)
    return Body(filled[:, :3], frame("x", filled[:, 3:6], "y", filled[:, 6:]), seen)


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
