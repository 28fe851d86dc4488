"""Holm's step-down adjustment: several tests, one promise.

Sort m p values; the smallest is multiplied by m, the next by m - 1, and so on; none may be smaller
than the one before it, and none exceeds 1. Rejecting where the adjusted p is at most alpha keeps
the chance of any false rejection at alpha, whatever the tests have to do with each other.
Holm 1979, Scandinavian Journal of Statistics 6:65-70.
"""

import math
from collections.abc import Sequence

from app.science.statistics.errors import StatisticsError


def holm(p_values: Sequence[float]) -> tuple[float, ...]:
    """Return the adjusted p values, in the order given.

    NaN (a test that could not be made) stays NaN and does not count among the m.

    Raises StatisticsError for a p outside 0..1.
    """
    wrong = [p for p in p_values if not math.isnan(p) and not 0.0 <= p <= 1.0]
    if wrong:
        raise StatisticsError(f"{wrong[0]} is no p value; they lie between 0 and 1.")
    adjusted = [math.nan] * len(p_values)
    made = sorted((p, place) for place, p in enumerate(p_values) if not math.isnan(p))
    highest = 0.0
    for step, (p, place) in enumerate(made):
        highest = max(highest, min(1.0, p * (len(made) - step)))
        adjusted[place] = highest
    return tuple(adjusted)
