"""Count path lengths, to see which lengths a database of walks has to cover.

The paper counts 3197 planned paths of an assembly line in the intervals of Methods-Time
Measurement, finds three quarters up to about 2 m, and leaves out the longest 5 % (above 4 m).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.science.walking.records import WalkingError

WIDTH_M = 0.5
CUTOFF = 0.05


@dataclass(frozen=True)
class Census:
    """Frequencies of path lengths.

    Attributes:
        count: number of paths.
        edges_m: (B + 1,) bounds of the intervals; a length on a bound belongs to the interval
            above.
        counts: (B,) number of paths in each interval.
        share_up_to: (B,) share of all paths up to each interval's upper bound.
        quartiles_m: the first, second and third quartile.
        cutoff_m: the length that a share of `cutoff` of the paths exceeds.
        total_m: sum of all lengths.
    """

    count: int
    edges_m: tuple[float, ...]
    counts: tuple[int, ...]
    share_up_to: tuple[float, ...]
    quartiles_m: tuple[float, float, float]
    cutoff_m: float
    total_m: float


def census(lengths_m: Sequence[float], width_m: float = WIDTH_M, cutoff: float = CUTOFF) -> Census:
    """Count lengths in intervals of equal width from 0.

    Raises:
        WalkingError: there are no lengths, a length is not positive, or there would be more than
            ten thousand intervals.
    """
    lengths = np.array(lengths_m, dtype=np.float64)
    if not len(lengths) or not (np.isfinite(lengths).all() and (lengths > 0.0).all()):
        raise WalkingError("A census needs lengths, each a positive number of metres.")
    intervals = float(lengths.max()) / width_m if width_m > 0.0 else np.inf
    if intervals > 10_000 or not 0.0 <= cutoff < 1.0:
        raise WalkingError(f"Intervals of {width_m} m or a cutoff of {cutoff} is invalid.")
    edges = np.arange(int(intervals) + 2) * width_m
    counts, _ = np.histogram(lengths, edges)
    first, second, third = np.quantile(lengths, (0.25, 0.5, 0.75))
    return Census(
        count=len(lengths),
        edges_m=tuple(edges.tolist()),
        counts=tuple(counts.tolist()),
        share_up_to=tuple((np.cumsum(counts) / len(lengths)).tolist()),
        quartiles_m=(float(first), float(second), float(third)),
        cutoff_m=float(np.quantile(lengths, 1.0 - cutoff)),
        total_m=float(lengths.sum()),
    )
