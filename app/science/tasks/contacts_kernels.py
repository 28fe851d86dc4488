"""Detect the contacts of one frame, compiled: the rules are those of `contacts`.

Importing this module loads the compiler.
"""

from math import inf, sqrt

import numpy as np
import numpy.typing as npt

from app.science.compiled import compiled

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]


@compiled
def _distance_m(start: Floats, end: Floats, low: Floats, high: Floats) -> float:
    """Return the exact distance between a segment and a box; see `segment_box_distance_m`."""
    t_low, t_high, s_low, s_high = 0.0, 1.0, -inf, inf
    for at in range(8):
        t = 1.0 if at == 7 else 0.0
        if 0 < at < 7:
            axis = (at - 1) % 3
            along = end[axis] - start[axis]
            if along != 0.0:
                face = low[axis] if at < 4 else high[axis]
                t = min(max((face - start[axis]) / along, 0.0), 1.0)
        slope = 0.0
        for axis in range(3):
            along = end[axis] - start[axis]
            point = start[axis] + t * along
            slope += (point - min(max(point, low[axis]), high[axis])) * along
        if slope <= 0.0:
            t_low, s_low = max(t_low, t), max(s_low, slope)
        if slope >= 0.0:
            t_high, s_high = min(t_high, t), min(s_high, slope)
    share = 0.0
    if s_low > -inf and s_high < inf and s_high > s_low:
        share = -s_low / (s_high - s_low)
    best = t_low + share * (t_high - t_low)
    squared = 0.0
    for axis in range(3):
        point = start[axis] + best * (end[axis] - start[axis])
        off = point - min(max(point, low[axis]), high[axis])
        squared += off * off
    return sqrt(squared)


@compiled
def _meet(start: Floats, end: Floats, reach_m: float, low: Floats, high: Floats) -> bool:
    """Return whether the bounding box of a capsule meets a box."""
    for axis in range(3):
        least, most = min(start[axis], end[axis]), max(start[axis], end[axis])
        if least - reach_m > high[axis] or most + reach_m < low[axis]:
            return False
    return True


@compiled
def contacts_of_frame(
    low_m: Floats, high_m: Floats, segments_m: Floats, radii_m: Floats, margin_m: float,
    touching: Bools, near: Bools,
) -> None:  # fmt: skip
    """Set which parts touch which surfaces, and which are within the margin, both (S, P).

    `low_m`, `high_m`: (S + 1, 3) corners of the surfaces, and last of the box around all of them.
    `segments_m`: (P, 2, 3); `radii_m`: (P,).
    """
    everything = low_m.shape[0] - 1
    for part in range(segments_m.shape[0]):
        start, end = segments_m[part, 0], segments_m[part, 1]
        reach_m = radii_m[part] + margin_m
        if not _meet(start, end, reach_m, low_m[everything], high_m[everything]):
            continue
        for surface in range(everything):
            if _meet(start, end, reach_m, low_m[surface], high_m[surface]):
                distance_m = _distance_m(start, end, low_m[surface], high_m[surface])
                touching[surface, part] = distance_m <= radii_m[part]
                near[surface, part] = distance_m <= reach_m
