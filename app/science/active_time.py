"""How much of a phase's active time had passed at each frame of a recording.

The clock of a phase stands in pauses and on walks back, and every frame says whether it ran when
the frame was shown. So the frames themselves tell the active time, and it can be told again for as
long as they are kept.
"""

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray


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
