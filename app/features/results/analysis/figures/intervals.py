"""A mean and how well it is known."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import stats

LEVEL = 0.95


@dataclass(frozen=True)
class MeanInterval:
    """Mean of n values with half the width of its 95 % interval; None for fewer than two."""

    mean: float
    half_width: float | None
    n: int

    def words(self, unit: str) -> str:
        """Half the width in words, for a hover text."""
        if self.half_width is None:
            return f"{unit} (one participant, no interval)"
        return f"± {self.half_width:.2g} {unit}"


def mean_interval(values: Sequence[float]) -> MeanInterval:
    """Student's interval: mean +- t(.975, n - 1) s / sqrt(n). Raises ValueError for no values."""
    if len(values) == 0:
        raise ValueError("expected at least one value, got none")
    array = np.asarray(values, np.float64)
    n, mean = len(array), float(array.mean())
    if n < 2:
        return MeanInterval(mean, None, n)
    quantile = float(stats.t.ppf(0.5 + LEVEL / 2, n - 1))
    return MeanInterval(mean, quantile * float(array.std(ddof=1)) / n**0.5, n)
