"""How the joint error of a phase develops: its mean in bins of active time.

People learn a delay, or tire of it, and a mean over the whole phase shows neither. A bin's value is
the mean over all samples that fall into it, a sample being one joint in one frame: so the mean of
the bins, each weighted by its samples, is the mean of the phase.

Active time is that in which the phase's clock ran (`active_times`). The clock of a phase stands in
pauses and on walks back, and every frame says whether it ran when the frame was shown. So the
frames themselves hold the active time, and it can be found again for as long as they are kept.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray

COURSE_BIN_S = 5.0
"""Active time in a bin, s: some 450 frames, so that single movements even out, and still twelve
bins in a phase of a minute."""
# The phase's count of seconds may be a rounding above a whole number of bins.
_ROUNDING_S = 1e-6


class CourseError(ValueError):
    """Errors and times do not belong together."""


@dataclass(frozen=True, eq=False)
class JointErrorCourse:
    """Means of B bins; the first begins when the phase's clock first ran, and none is left out.

    Attributes:
        mean_rad: (B,) mean angle; NaN for a bin without samples.
        samples: (B,) joints times frames that count.
    """

    bin_s: ClassVar[float] = COURSE_BIN_S

    mean_rad: FloatArray
    samples: npt.NDArray[np.int64]


def joint_error_course(
    angles_rad: FloatArray, active_s: FloatArray, duration_s: float
) -> JointErrorCourse:
    """Return the course of N frames.

    Args:
        angles_rad: (N, J) angle of each joint; NaN where a sample does not count.
        active_s: (N,) active time of each frame, s, finite and not below zero.
        duration_s: active time that the phase had by its own count. Frames behind it, as from a
            clock that jumped, belong to its last bin; so no bin holds a few frames only because
            the two counts differ by less than a frame.

    Returns:
        The bins up to the last that has a frame; none without frames.

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

    From a frame in which the clock runs, time counts up to the next frame, also over a gap; what a
    frame that stopped the clock is late by and what one that started it is late by cancel out on
    average. A time that is not finite, or not later than all before, adds nothing.

    Args:
        times_s: (N,) on one clock, in the order in which the frames were made; may hold anything.
        active: (N,) whether the phase's clock ran.

    Returns:
        (N,) s, from 0 on, never falling.
    """
    passed_s = np.zeros(len(times_s))
    finite = np.isfinite(times_s)
    if not finite.any():
        return passed_s
    # Before the first usable time nothing has passed.
    known_s = np.where(finite, times_s, -np.inf)
    latest_s = np.maximum(np.maximum.accumulate(known_s), times_s[np.argmax(finite)])
    passed_s[1:] = np.cumsum(np.diff(latest_s) * active[:-1])
    return passed_s
