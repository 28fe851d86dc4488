"""When frames came: intervals, gaps, and clocks that ran backwards."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.science.stream_quality.limits import QualityLimits
from app.science.stream_quality.memory import Memory


@dataclass(frozen=True)
class Pacing:
    """Per frame (n,), against the frame before it that has a time.

    `interval_s` is NaN where there is none. `gap`: nothing came for too long before this frame.
    `backwards`: the frame is not later than the one before. `watched_s`: how much of the interval
    was covered by frames, 0 over a gap. `usual_s` is the interval frames usually have, NaN where
    that is unknown.
    """

    interval_s: NDArray[np.float64]
    gap: NDArray[np.bool_]
    backwards: NDArray[np.bool_]
    watched_s: NDArray[np.float64]
    usual_s: float


def is_timed(times_s: NDArray[np.float64], limits: QualityLimits) -> NDArray[np.bool_]:
    """Frames (n,) whose time can be one."""
    return np.asarray(np.abs(times_s) <= limits.latest_s)  # NaN is not


def pace(
    times_s: NDArray[np.float64], limits: QualityLimits, usual_s: float | None, before: Memory
) -> Pacing:
    """Judge times (n,); `usual_s` None takes the median interval of this span."""
    interval_s = np.full(len(times_s), np.nan)
    timed = is_timed(times_s, limits)
    first = np.nan if before.time_s is None else before.time_s
    interval_s[timed] = np.diff(times_s[timed], prepend=first)
    forward = interval_s > 0.0
    if usual_s is None:
        usual_s = float(np.median(interval_s[forward])) if forward.any() else np.nan
    longest_s = np.fmax(limits.gap_frames * usual_s, limits.gap_s)
    gap = interval_s > longest_s
    return Pacing(
        interval_s=interval_s,
        gap=gap,
        backwards=interval_s <= 0.0,
        watched_s=np.where(forward & ~gap, interval_s, 0.0),
        usual_s=usual_s,
    )
