"""Compute the course of the joint error over a phase: its mean in bins of active time.

People adapt to a delay, or tire of it, and a mean over the whole phase shows neither. The value of
a bin is the mean over all samples in it, a sample being one joint in one frame: so the mean of the
bins, each weighted by its samples, is the mean of the phase.

Active time is the time in which the phase's clock ran (`active_times`). The clock is stopped in
pauses and on walks back, and every frame records whether it was running when the frame was shown.
So the active time can be computed from the stored frames alone.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray

COURSE_BIN_S = 5.0
"""Active time of a bin, s: about 450 frames, which average out single movements, and still twelve
bins in a phase of one minute."""
# The phase's own duration may exceed a whole number of bins by a rounding error.
_ROUNDING_S = 1e-6


class CourseError(ValueError):
    """The shapes of the joint errors and of their times do not match."""


@dataclass(frozen=True, eq=False)
class JointErrorCourse:
    """Mean joint errors in B consecutive bins of active time, from the start of the phase's clock.

    Attributes:
        mean_rad: (B,) mean angle; NaN for a bin without samples.
        samples: (B,) number of samples (joints times frames) that count.
    """

    bin_s: ClassVar[float] = COURSE_BIN_S

    mean_rad: FloatArray
    samples: npt.NDArray[np.int64]


def joint_error_course(
    angles_rad: FloatArray, active_s: FloatArray, duration_s: float
) -> JointErrorCourse:
    """Return the mean joint error in each bin of active time, from N frames.

    Args:
        angles_rad: (N, J) angle of each joint; NaN where a sample does not count.
        active_s: (N,) active time of each frame, s, finite and not below zero.
        duration_s: the phase's active time by its own count. Later frames, as after a jump of the
            clock, belong to its last bin; so no bin has only a few frames because the two counts
            differ by less than a frame.

    Returns:
        The bins up to the last that has a frame; no bins if there are no frames.

    Raises:
        CourseError: the shapes do not fit.
    """
    if angles_rad.ndim != 2 or active_s.shape != angles_rad.shape[:1]:
        raise CourseError(
            f"Angles {angles_rad.shape} and active times {active_s.shape} do not fit: they must be"
            " (N, J) and (N,), frame for frame."
        )
    last = max(int(np.ceil((duration_s - _ROUNDING_S) / COURSE_BIN_S)) - 1, 0)
    bins = np.minimum(np.floor(active_s / COURSE_BIN_S), last).astype(np.int64)
    counted = np.isfinite(angles_rad)
    samples = np.bincount(bins, counted.sum(axis=1)).astype(np.int64)
    sums_rad = np.bincount(bins, np.where(counted, angles_rad, 0.0).sum(axis=1))
    mean_rad = np.full(len(samples), np.nan)
    np.divide(sums_rad, samples, out=mean_rad, where=samples > 0)
    return JointErrorCourse(mean_rad, samples)


def active_times(times_s: FloatArray, active: npt.NDArray[np.bool_]) -> FloatArray:
    """Return the active time at each of N frames, in s since the first.

    From a frame in which the clock runs, time counts up to the next frame, also over a gap. A frame
    that reports a stop of the clock comes a little late, and so does one that reports a start; on
    average the two delays cancel out. A time that is not finite, or not later than all previous
    ones, adds nothing.

    Args:
        times_s: (N,) times on one clock, in the order in which the frames were made; any values are
            allowed.
        active: (N,) whether the phase's clock ran.

    Returns:
        (N,) s, starting at 0, never decreasing.
    """
    elapsed_s = np.zeros(len(times_s))
    finite = np.isfinite(times_s)
    if not finite.any():
        return elapsed_s
    # No time elapses before the first finite time.
    finite_s = np.where(finite, times_s, -np.inf)
    latest_s = np.maximum(np.maximum.accumulate(finite_s), times_s[np.argmax(finite)])
    elapsed_s[1:] = np.cumsum(np.diff(latest_s) * active[:-1])
    return elapsed_s
