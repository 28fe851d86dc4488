"""Score how well draws predict an outcome: continuous ranked probability score, and coverage.

    CRPS(F, t) = E|T - t| - E|T - T'| / 2,   T and T' independent from F

The score is proper: the true distribution has the smallest expected score. For a single number
instead of a distribution it is the absolute error, so that all models are on one scale, in seconds.
Models are chosen by it, and evaluations compare by it.
"""

import numpy as np

from app.science.rotations import FloatArray


def crps_s(draws_s: FloatArray, truth_s: float) -> float:
    """Return the CRPS of draws (S,) for the true value; the absolute error for a single draw."""
    ordered = np.sort(draws_s)
    count = len(ordered)
    ranks = 2.0 * np.arange(count) - count + 1.0
    # The mean of |T - T'| over all pairs of draws, computed by ranks.
    apart = 2.0 * float(ranks @ ordered) / count**2
    return float(np.abs(ordered - truth_s).mean()) - apart / 2.0


def covers(draws_s: FloatArray, truth_s: float, share: float) -> bool:
    """Return whether the central interval with this share of the draws contains the true value."""
    low, high = np.quantile(draws_s, [(1.0 - share) / 2.0, (1.0 + share) / 2.0])
    return bool(low <= truth_s <= high)


def iqr(values: FloatArray) -> float:
    """Return the interquartile range."""
    first, third = np.quantile(values, (0.25, 0.75))
    return float(third - first)
