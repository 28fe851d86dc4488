"""The power of a test on simulated data sets, with what the number of data sets leaves open.

Power is the share of data sets with the assumed effect in which the test is significant, level the
same share without the effect. A data set on which the test cannot be computed is one in which it is
not significant; it is counted, never left out. Among significant results, type S is the share with
the wrong sign, and type M how many times too large the estimate is on average: Gelman and Carlin
2014, Perspectives on Psychological Science 9:641-651.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.science.statistics import FloatArray, IntArray, clopper_pearson

BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Results:
    """The results of the same test on several data sets, each an array over them.

    Attributes:
        significant: whether the test was significant.
        failed: whether it could not be computed; such a data set is never significant.
        estimates: the estimated difference; NaN where there was nothing to estimate.
        in_test: the number of participants in the test.
    """

    significant: BoolArray
    failed: BoolArray
    estimates: FloatArray
    in_test: IntArray


@dataclass(frozen=True)
class PowerPoint:
    """Power and level at one number of participants.

    Attributes:
        n: participants who start.
        sets: data sets, as many with the effect as without it.
        power, low, high: share of significant tests with its Clopper-Pearson interval of 95 %.
        level, level_low, level_high: the same without the effect.
        failures, level_failures: data sets on which the test could not be computed.
        mean_in_test: mean number of participants in the test.
        type_s: share of significant estimates with the wrong sign; None without any.
        type_m: mean size of significant estimates over the assumed one; None without any.
        mean_estimate: mean estimate over all data sets; None without any.
    """

    n: int
    sets: int
    power: float
    low: float
    high: float
    level: float
    level_low: float
    level_high: float
    failures: int
    level_failures: int
    mean_in_test: float
    type_s: float | None
    type_m: float | None
    mean_estimate: float | None

    @property
    def never_tested(self) -> bool:
        """Whether the test could be computed on no data set, so that 0 is no finding."""
        return self.failures == self.level_failures == self.sets


def power_point(n: int, effect: Results, null: Results, assumed: float) -> PowerPoint:
    """Summarise the tests of data sets with n participants.

    Args:
        n: participants who start.
        effect: results on data sets with the assumed effect.
        null: results on data sets without it.
        assumed: the assumed difference, in the unit of the estimates.

    Raises:
        StatisticsError: there is no data set.
    """
    power, low, high = _share(effect)
    level, level_low, level_high = _share(null)
    found = effect.estimates[effect.significant & np.isfinite(effect.estimates)]
    all_of_them = effect.estimates[np.isfinite(effect.estimates)]
    known = bool(found.size) and assumed != 0.0
    return PowerPoint(
        n=n,
        sets=effect.significant.size,
        power=power,
        low=low,
        high=high,
        level=level,
        level_low=level_low,
        level_high=level_high,
        failures=int(effect.failed.sum()),
        level_failures=int(null.failed.sum()),
        mean_in_test=float(effect.in_test.mean()),
        type_s=float(np.mean(found * assumed < 0.0)) if known else None,
        type_m=float(np.mean(np.abs(found)) / abs(assumed)) if known else None,
        mean_estimate=float(all_of_them.mean()) if all_of_them.size else None,
    )


def smallest_sufficient(points: Sequence[PowerPoint], target: float) -> int | None:
    """Return the smallest n of which even the lower bound of power reaches the target, or None."""
    return min((point.n for point in points if point.low >= target), default=None)


def _share(tested: Results) -> tuple[float, float, float]:
    sets = tested.significant.size
    significant = int((tested.significant & ~tested.failed).sum())
    low, high = clopper_pearson(significant, sets)
    return significant / sets, low, high
