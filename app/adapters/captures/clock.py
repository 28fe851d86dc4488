"""Times of loggers: from the first sample on, and strictly forward."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.adapters.captures.capture import CaptureError, Convention
from app.science.rotations import FloatArray

_LONGEST_S = 1e7


@dataclass(frozen=True, eq=False)
class SampleTimes:
    """Which rows to keep, when they were, and what was repaired.

    Attributes:
        kept: (N,) rows of the table whose time lies after that of the row before.
        times_s: (N,) from the first of them on.
        notes: a sentence if rows were left out.
    """

    kept: npt.NDArray[np.intp]
    times_s: FloatArray
    notes: tuple[str, ...]


def sample_times(seconds: FloatArray, lines: npt.NDArray[np.int64]) -> SampleTimes:
    """Count times from the first; rows that repeat a time are left out.

    Raises:
        CaptureError: a time is missing or absurd, or the clock went back.
    """
    wrong = np.flatnonzero(~(np.abs(seconds) < 1e12))
    if wrong.size:
        raise CaptureError(
            f"the time is {seconds[wrong[0]]:g}: seconds are valid.", line=int(lines[wrong[0]])
        )
    times_s = seconds - seconds[0]
    steps = np.diff(times_s)
    back = np.flatnonzero(steps < 0.0)
    if back.size:
        row = int(back[0]) + 1
        raise CaptureError(
            f"the time goes back from {seconds[row - 1]:.6f} s to {seconds[row]:.6f} s: give one"
            " recording a file.",
            line=int(lines[row]),
        )
    if times_s[-1] > _LONGEST_S:
        raise CaptureError(f"the log spans {times_s[-1]:g} s: seconds are valid.")
    kept = np.flatnonzero(np.concatenate(([True], steps > 1e-9)))
    double = len(times_s) - len(kept)
    notes = (f"{double} rows repeat the time of the row before and were left out.",)
    return SampleTimes(kept, times_s[kept], notes if double else ())


def logged_rate(rate_hz: float) -> Convention:
    """How fast a logger wrote: by the median step of its times."""
    if rate_hz <= 0.0:
        return Convention("one sample", "file")
    return Convention(f"{rate_hz:.4g} Hz by the median step", "file")
