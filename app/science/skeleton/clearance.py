"""Raise a body smoothly where its feet would be under the floor.

A capture knows the height of a foot to a few centimetres only: markers sit on shoes, joints are
solved with other bones than the avatar's, and on a longer walk the floor itself drifts. The height
h(t) of the lowest point above the floor therefore falls below zero now and then. The body is raised
by

    r(t) = mean over T of the largest max(0, -a - h) within T before and after,

with T = `SMOOTHING_S` and `a` the depth that is allowed. A mean over a running maximum is smooth,
and never below what is needed. Joint angles stay as they are, and a body that never sinks is not
moved. What is traded: feet float by up to r(t) near a frame that would have sunk.
"""

import numpy as np

from app.science.rotations import FloatArray

SMOOTHING_S = 0.15
"""About the duration of a foot's landing: longer raises more than needed, shorter would bounce."""


def clearance_m(lowest_m: FloatArray, rate_hz: float, *, allowed_m: float = 0.0) -> FloatArray:
    """Return by how much a body is raised in each frame, (N,), at least zero.

    Args:
        lowest_m: (N,) height above the floor of the lowest point of the body.
        rate_hz: frames per second.
        allowed_m: depth under the floor that is left as it is.
    """
    need = np.maximum(-allowed_m - lowest_m, 0.0)
    if not need.any():
        return need
    from scipy.ndimage import maximum_filter1d, uniform_filter1d  # slow to import

    reach = max(1, round(SMOOTHING_S * rate_hz))
    widest = maximum_filter1d(need, 2 * reach + 1, mode="nearest")
    span = 2 * (reach // 2) + 1
    once = uniform_filter1d(widest, span, mode="nearest")
    return np.asarray(uniform_filter1d(once, span, mode="nearest"))
