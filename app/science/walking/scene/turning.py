"""Compute how much a path turns: the integral of |curvature| along it, in radians per metre.

The paper sums |curvature| over the samples of a capture. At a capture's sampling rate that measures
jitter: it gives hundreds on straight walks. Here the path is resampled at equal distances of one
centimetre, smoothed as in the paper, and the changes of its direction are added up, without the
first and last 5 cm, where the direction is unreliable.
"""

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records import WalkingError, arc_of

SPACING_M = 0.01
SIGMA_SAMPLES = 2.0
TRIM_M = 0.05


def by_length(points_m: FloatArray, spacing_m: float = SPACING_M) -> FloatArray:
    """Resample a line (N, 2) at equal distances along it, both ends included.

    Raises:
        WalkingError: the line has no length.
    """
    arc = arc_of(points_m)
    if not arc[-1] > 0.0:
        raise WalkingError("A path of no length has no direction.")
    at = np.linspace(0.0, arc[-1], max(2, round(float(arc[-1]) / spacing_m) + 1))
    return np.stack([np.interp(at, arc, points_m[:, axis]) for axis in (0, 1)], axis=-1)


def total_turning(points_m: FloatArray) -> float:
    """Return the sum of the absolute changes of a line's direction, in radians."""
    from scipy.ndimage import gaussian_filter1d

    even = gaussian_filter1d(by_length(points_m), SIGMA_SAMPLES, axis=0, mode="nearest")
    steps = np.diff(even, axis=0)
    trim = round(TRIM_M / SPACING_M)
    if len(steps) > 2 * trim + 1:
        steps = steps[trim:-trim]
    ahead = (steps[1:] * steps[:-1]).sum(axis=1)
    aside = steps[:-1, 0] * steps[1:, 1] - steps[:-1, 1] * steps[1:, 0]
    return float(np.abs(np.arctan2(aside, ahead)).sum())


def turning_per_m(points_m: FloatArray) -> float:
    """Return the total turning of a line divided by its length."""
    length = float(np.linalg.norm(np.diff(points_m, axis=0), axis=1).sum())
    return total_turning(points_m) / length if length > 0.0 else total_turning(points_m)
