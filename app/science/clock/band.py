"""All straight lines that lie between upper and lower bounds, and the best-fitting one of them.

A line a + b (t - ref) lies below all upper bounds and above all lower bounds if

    low(b) = max_i (lower_i - b (t_i - ref)) <= a <= high(b) = min_j (upper_j - b (t_j - ref)).

`high` is concave and piecewise linear; its corners are at the slopes of the lower convex hull of
the upper bounds. `low` is convex; its corners are at the slopes of the upper hull of the lower
bounds. The lines therefore form a convex polygon in (a, b) whose corners are known exactly, and the
largest and the smallest value that any of them takes at a time t is found among the corners. No
solver is needed.

One line of a band is reported as the offset (`best_line`). The best estimate of the delay in either
direction is half the round trip, and it is better the shorter the round trip was, because queueing
delays mostly affect one direction only. The line is therefore a least-squares fit to the probes'
offsets, with weights that fall with the queueing delay,

    sigma_i = slack + (round_trip_i - shortest) / 2,

and a Gaussian prior with mean 0 and the drift limit as standard deviation keeps the drift small
where there are too few probes to determine it. The line is then clamped to the band, because the
true offset cannot lie outside it.
"""

from dataclasses import dataclass

import numpy as np

from app.science.clock.probes import Bounds, ClockLimits, ClockProbes, FloatArray


@dataclass(frozen=True, eq=False)
class Band:
    """All lines offset_s + a + b (t - ref_s) between the bounds of a window.

    For each slope b in `slopes` (v,), `low_s` and `high_s` (v,) are the lowest and highest a.
    Slopes ascend; between two of them `low_s` and `high_s` are linear.
    """

    ref_s: float
    offset_s: float
    slopes: FloatArray
    low_s: FloatArray
    high_s: FloatArray

    def at(self, t_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the lowest and highest value of any line at each time (k,), each (k,)."""
        moved = np.multiply.outer(t_s - self.ref_s, self.slopes)
        low = self.offset_s + (moved + self.low_s).min(axis=-1)
        high = self.offset_s + (moved + self.high_s).max(axis=-1)
        return low, high

    def nearest(self, a_s: float, slope: float) -> tuple[float, float]:
        """Clamp a line to the band, its slope first and then its height; return (height, slope)."""
        slope = float(np.clip(slope, self.slopes[0], self.slopes[-1]))
        low = float(np.interp(slope, self.slopes, self.low_s))
        high = float(np.interp(slope, self.slopes, self.high_s))
        return float(np.clip(a_s, low, high)), slope


def band_of(bounds: Bounds, drift: float) -> Band | None:
    """Return all lines with |slope| <= `drift` between the bounds; None if there is none."""
    ref_s = 0.5 * float(bounds.upper_t_s[0] + bounds.lower_t_s[-1])
    offset_s = 0.5 * float(bounds.upper_s[0] + bounds.lower_s[0])
    upper = _hull(bounds.upper_t_s - ref_s, bounds.upper_s - offset_s)
    # The upper hull is the lower hull of the points mirrored at the time axis.
    mirrored = _hull(bounds.lower_t_s - ref_s, offset_s - bounds.lower_s)
    corners = np.concatenate((_slopes(upper), -_slopes(mirrored)))
    inner = corners[np.abs(corners) < drift]
    slopes = np.unique(np.concatenate(([-drift], inner, [drift])))
    high = (upper[:, 1] - np.multiply.outer(slopes, upper[:, 0])).min(axis=1)
    low = -(mirrored[:, 1] + np.multiply.outer(slopes, mirrored[:, 0])).min(axis=1)
    if (high < low).all():
        return None
    return _cut(ref_s, offset_s, slopes, low, high)


def _cut(
    ref_s: float, offset_s: float, slopes: FloatArray, low: FloatArray, high: FloatArray
) -> Band:
    """Keep the slopes for which a line exists, and add the two slopes at which the polygon ends."""
    room = high - low
    kept = np.flatnonzero(room >= 0.0)
    first, last = int(kept[0]), int(kept[-1])
    rows = [(slopes[at], low[at], high[at]) for at in range(first, last + 1)]
    for inside, outside in ((first, first - 1), (last, last + 1)):
        if 0 <= outside < len(slopes):
            share = room[inside] / (room[inside] - room[outside])
            end = [
                values[inside] + share * (values[outside] - values[inside])
                for values in (slopes, low, high)
            ]
            rows.insert(0 if outside < inside else len(rows), (end[0], end[1], end[2]))
    table = np.array(rows, dtype=np.float64)
    return Band(ref_s, offset_s, table[:, 0], table[:, 1], table[:, 2])


def _hull(x: FloatArray, y: FloatArray) -> FloatArray:
    """Return the corners of the lower convex hull of points, (h, 2), from left to right.

    Monotone chain (Andrew 1979).
    """
    order = np.lexsort((y, x))
    chain: list[tuple[float, float]] = []
    for px, py in zip(x[order].tolist(), y[order].tolist(), strict=True):
        if chain and px == chain[-1][0]:
            continue
        while len(chain) >= 2:
            (ax, ay), (bx, by) = chain[-2], chain[-1]
            if (bx - ax) * (py - ay) > (by - ay) * (px - ax):
                break
            chain.pop()
        chain.append((px, py))
    return np.array(chain, dtype=np.float64)


def _slopes(hull: FloatArray) -> FloatArray:
    steps = np.diff(hull, axis=0)
    slopes: FloatArray = steps[:, 1] / steps[:, 0]
    return slopes


def best_line(probes: ClockProbes, band: Band, limits: ClockLimits) -> tuple[float, float]:
    """Return the offset at `band.ref_s` in s and the drift in s/s of the best-fitting line."""
    t_s = probes.middle_s - band.ref_s
    offset_s = probes.offset_s - band.offset_s
    round_trip_s = probes.round_trip_s
    sigma_s = limits.slack_s + 0.5 * (round_trip_s - round_trip_s.min())
    weight = sigma_s**-2
    centre_s = np.average(t_s, weights=weight)
    mean_s = np.average(offset_s, weights=weight)
    spread = np.sum(weight * (t_s - centre_s) ** 2) + limits.drift**-2
    drift = float(np.sum(weight * (t_s - centre_s) * (offset_s - mean_s)) / spread)
    a_s, drift = band.nearest(float(mean_s - drift * centre_s), drift)
    return band.offset_s + a_s, drift
