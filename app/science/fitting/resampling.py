"""Resample rigid bodies to a constant rate, which rigs need but trackers' logs seldom have.

Where markers were not seen, short gaps are bridged and the longest stretch without a gap is kept.
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
    """A rigid body at a constant rate, short gaps bridged: its positions (N, 3) in metres.

    `axes` (N, 3, 3) are its axes in the world; `seen` (N,) is false where a gap was bridged.
    """

    places: FloatArray
    axes: FloatArray
    seen: BoolArray


def bodies_at_constant_rate(
    motion: BodyMotion, chosen: dict[str, str]
) -> tuple[float, dict[str, Body]]:
    """Return the rate in Hz and the chosen bodies by role (role -> name).

    If intervals differ from their median by more than a twentieth, the samples are interpolated
    linearly at regular times.

    Raises:
        FitError: times do not increase, or have gaps so long that most samples would be
            interpolated.
    """
    steps = np.diff(motion.times_s)
    if len(steps) < 1 or not np.isfinite(steps).all() or not (steps > 0.0).all():
        raise FitError("The times of the bodies do not increase from sample to sample.")
    rate_hz = motion.rate_hz
    columns = {role: _column(motion, name) for role, name in chosen.items()}
    if np.abs(steps * rate_hz - 1.0).max() > _STEADY:
        count = round(float(motion.times_s[-1] - motion.times_s[0]) * rate_hz) + 1
        if count > _MOST_SAMPLES * motion.frame_count:
            raise FitError(
                "Most of the recording is missing: cut it at the gaps between its times."
            )
        times = motion.times_s[0] + np.arange(count) / rate_hz
        columns = {
            role: _interpolated(times, motion.times_s, values) for role, values in columns.items()
        }
    return rate_hz, {role: _make_body(values, rate_hz) for role, values in columns.items()}


def _column(motion: BodyMotion, name: str) -> FloatArray:
    """Return position, x axis and y axis of a body, (N, 9).

    Linear interpolation between axes gives vectors that are still close to axes.
    """
    body = motion.names.index(name)
    rotations = motion.rotations[:, body]
    x, y = (rotate(rotations, np.array(axis)) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    return np.concatenate((motion.positions_m[:, body], x, y), axis=-1)


def _interpolated(times: FloatArray, sample_times: FloatArray, values: FloatArray) -> FloatArray:
    """Interpolate values linearly at regular times.

    The result is NaN between samples that are further apart than the longest gap to be bridged.
    """
    after = np.clip(np.searchsorted(sample_times, times), 1, len(sample_times) - 1)
    span = sample_times[after] - sample_times[after - 1]
    share = ((times - sample_times[after - 1]) / span)[:, None]
    out = (1.0 - share) * values[after - 1] + share * values[after]
    exact = np.where(share <= 0.0, values[after - 1], np.where(share >= 1.0, values[after], out))
    filled: FloatArray = np.where((span <= LONGEST_BRIDGE_S)[:, None], exact, np.nan)
    return filled


def _make_body(values: FloatArray, rate_hz: float) -> Body:
    filled, seen = bridged(values, rate_hz)
    return Body(filled[:, :3], frame("x", filled[:, 3:6], "y", filled[:, 6:]), seen)


LONGEST_BRIDGE_S = 0.5


def bridged(values: FloatArray, rate_hz: float) -> tuple[FloatArray, BoolArray]:
    """Fill gaps of up to half a second by linear interpolation.

    Args:
        values: (N, K) values, with NaN rows where nothing was seen.
        rate_hz: frames per second.

    Returns:
        The values, NaN where a gap is longer or at the start or end, and (N,) whether each was
        seen.
    """
    seen: BoolArray = np.all(np.isfinite(values), axis=-1)
    seen_frames = np.flatnonzero(seen)
    if len(seen_frames) < 2 or seen.all():
        return np.where(seen[:, None], values, np.nan), seen
    frames = np.arange(len(values))
    filled = np.stack(
        [np.interp(frames, seen_frames, column[seen_frames]) for column in values.T], axis=-1
    )
    before = np.searchsorted(seen_frames, frames, side="right") - 1
    after = np.searchsorted(seen_frames, frames, side="left")
    inside = (before >= 0) & (after < len(seen_frames))
    width = (
        seen_frames[np.minimum(after, len(seen_frames) - 1)]
        - seen_frames[np.maximum(before, 0)]
        - 1
    )
    short = inside & (width <= LONGEST_BRIDGE_S * rate_hz)
    return np.where((seen | short)[:, None], filled, np.nan), seen


def longest_run(good: BoolArray) -> tuple[int, int]:
    """Return first frame and end of the longest run of good frames; (0, 0) if there is none."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], good.astype(np.int8), [0]))))
    if len(edges) == 0:
        return 0, 0
    starts, ends = edges[::2], edges[1::2]
    longest = int(np.argmax(ends - starts))
    return int(starts[longest]), int(ends[longest])
