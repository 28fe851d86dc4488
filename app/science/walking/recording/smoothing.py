"""Smoothing of captured tracks, as in the paper.

The paper filters its captures of 120 Hz with `gaussian_filter1d`, sigma = 2 samples, so that the
jerks of each step matter less. At other rates sigma is the same time, 1/60 s.
"""

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records import Track

SIGMA_S = 2.0 / 120.0
REACH = 4.0
"""The filter ends that many sigma away, as SciPy's does."""


def evenly(track: Track) -> tuple[FloatArray, FloatArray]:
    """Times and places of a track at a constant rate, its own by the median step.

    Loggers seldom keep one; a filter over samples needs it.
    """
    times_s, rate_hz = track.times_s, track.rate_hz
    count = max(2, round((times_s[-1] - times_s[0]) * rate_hz) + 1)
    even_s = np.linspace(times_s[0], times_s[-1], count)
    columns = [np.interp(even_s, times_s, track.xy_m[:, axis]) for axis in (0, 1)]
    return even_s, np.stack(columns, axis=-1)


def smoothed(xy_m: FloatArray, rate_hz: float, sigma_s: float = SIGMA_S) -> FloatArray:
    """Filter places (N, 2) at a constant rate.

    At its ends a track is continued by turning it about its last point: that point stays, and so
    does the speed of somebody whom the recording cuts amid a walk.
    """
    from scipy.ndimage import gaussian_filter1d

    sigma = sigma_s * rate_hz
    if sigma <= 0.0 or len(xy_m) < 2:
        return xy_m
    beyond = int(np.ceil(REACH * sigma))
    longer = np.pad(xy_m, ((beyond, beyond), (0, 0)), mode="reflect", reflect_type="odd")
    places: FloatArray = gaussian_filter1d(longer, sigma, axis=0, truncate=REACH)
    return places[beyond:-beyond]
