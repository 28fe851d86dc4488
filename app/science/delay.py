"""The delayed-copy avatar: every joint except the hips repeats the participant's movement later.

At time t a joint takes the local rotation that the participant's joint had at t - delay, by slerp
between the two samples around that time; before the first sample it keeps the first rotation. The
hips, and with them the position of the body, follow without delay: a delayed viewpoint would make
people sick. With a delay of zero the rotations are returned unchanged, to the bit.

Source: Karas (2020), section 7.1: latency is added to the target rotations of every body part
except the hips, and 0 ms bypasses the buffer.
"""

import math
from collections import deque

import numpy as np

from app.science.rotations import FloatArray, slerp

_HIPS = 0

LONGEST_DELAY_S = 2.0
"""The longest delay that a buffer of poses allows unless it is made for a longer one."""


class DelayError(ValueError):
    """A delay or a time is not valid: negative, not finite, or out of order."""


def delayed_pose(
    times_s: FloatArray, rotations: FloatArray, query_times_s: FloatArray, delay_s: float
) -> FloatArray:
    """Return the avatar's local rotations (M, 22, 4) at the query times.

    Args:
        times_s: (N,) strictly increasing times of the samples.
        rotations: (N, 22, 4) the participant's local rotations, wxyz.
        query_times_s: (M,) times at which to compute the pose. The undelayed hips are interpolated
            at these times too.
        delay_s: the delay, at least zero.

    Raises:
        DelayError: there are no samples, the times do not increase, or the delay is not valid.
    """
    _check_delay(delay_s)
    if times_s.size == 0 or times_s.shape[0] != rotations.shape[0]:
        raise DelayError(
            f"{times_s.shape[0]} times and {rotations.shape[0]} samples: give one time per sample."
        )
    if not np.isfinite(times_s).all() or bool(np.any(np.diff(times_s) <= 0.0)):
        raise DelayError("Sample times must be finite and rise strictly from sample to sample.")
    result = _sample(times_s, rotations, query_times_s - delay_s)
    if delay_s > 0.0:
        hips = rotations[:, _HIPS : _HIPS + 1]
        result[:, _HIPS] = _sample(times_s, hips, query_times_s)[:, 0]
    return result


def _sample(times_s: FloatArray, rotations: FloatArray, at_s: FloatArray) -> FloatArray:
    """Interpolate the rotations at any times: exact at a sample, constant beyond both ends."""
    after = np.searchsorted(times_s, at_s, side="left")
    last = times_s.shape[0] - 1
    result: FloatArray = rotations[np.minimum(after, last)]  # fancy indexing copies
    within = (after > 0) & (after <= last)
    within &= times_s[np.minimum(after, last)] != at_s
    if bool(np.any(within)):
        high = after[within]
        low = high - 1
        fraction = (at_s[within] - times_s[low]) / (times_s[high] - times_s[low])
        result[within] = slerp(rotations[low], rotations[high], fraction[:, np.newaxis])
    return result


class DelayBuffer:
    """Computes the delayed-copy avatar frame by frame, with a delay that can change at any moment.

    The buffer keeps enough samples for the longest delay that it allows. A change of the delay
    takes effect with the next frame; the avatar then jumps in time, as it does between the study's
    conditions.
    """

    def __init__(self, delay_s: float, *, longest_delay_s: float = LONGEST_DELAY_S) -> None:
        self._longest_s = longest_delay_s
        self._samples: deque[tuple[float, FloatArray]] = deque()
        self._delay_s = 0.0
        self.set_delay(delay_s)

    @property
    def delay_s(self) -> float:
        """The current delay, in seconds."""
        return self._delay_s

    def set_delay(self, delay_s: float) -> None:
        """Change the delay, from the next frame on.

        Raises:
            DelayError: below zero, not finite, or longer than the buffer allows.
        """
        _check_delay(delay_s)
        if delay_s > self._longest_s:
            raise DelayError(
                f"A delay of {delay_s} s exceeds the {self._longest_s} s that this buffer allows:"
                " make it with a larger longest_delay_s."
            )
        self._delay_s = delay_s

    def clear(self) -> None:
        """Forget all samples; the next one may be at any time."""
        self._samples.clear()

    def push(self, time_s: float, rotations: FloatArray) -> FloatArray:
        """Add the participant's current local rotations (22, 4) and return the avatar's.

        The arrays are stored, not copied: do not change them afterwards.

        Raises:
            DelayError: the time is not later than the previous one.
        """
        if not math.isfinite(time_s) or (self._samples and time_s <= self._samples[-1][0]):
            raise DelayError(f"Time {time_s} s is not later than the last sample: push in order.")
        self._samples.append((time_s, rotations))
        self._forget(time_s - self._longest_s)
        if self._delay_s == 0.0:
            return rotations
        delayed = self._at(time_s - self._delay_s).copy()
        delayed[_HIPS] = rotations[_HIPS]
        return delayed

    def _forget(self, before_s: float) -> None:
        # One sample at or before the oldest possible query must stay, to interpolate from.
        while len(self._samples) > 2 and self._samples[1][0] <= before_s:
            self._samples.popleft()

    def _at(self, at_s: float) -> FloatArray:
        samples = self._samples
        high = len(samples) - 1
        while high > 0 and samples[high - 1][0] >= at_s:
            high -= 1
        if high == 0 or samples[high][0] == at_s:
            return samples[high][1]
        low_s, low = samples[high - 1]
        high_s, upper = samples[high]
        return slerp(low, upper, (at_s - low_s) / (high_s - low_s))


def _check_delay(delay_s: float) -> None:
    if not math.isfinite(delay_s) or delay_s < 0.0:
        raise DelayError(f"A delay of {delay_s} s is not valid: give zero or more seconds.")
