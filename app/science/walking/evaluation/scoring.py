"""Errors of travel times as the paper tells them, and two models compared by them.

The paper takes one draw and compares |dt|. That punishes honesty: where walks differ, a draw from
their true distribution is off by about sqrt 2 times as much as the distribution's median, so a
model that knows nothing of variety wins. `crps` has the score that is judged by.
SciPy is slow to load, so only what needs it does.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records import WalkingError

PERCENTILES = (5.0, 25.0, 50.0, 75.0, 95.0)
"""As the paper prints them."""
COVERAGES = (0.5, 0.9)
ALPHA = 0.05
EFFICIENCY = 0.864
"""Least asymptotic relative efficiency of the signed-rank test to the t test (Hodges, Lehmann)."""


@dataclass(frozen=True)
class ErrorSummary:
    """Absolute travel-time errors as the paper tells them.

    Attributes:
        count: how many.
        percentiles_s: at `PERCENTILES`.
        shapiro_p: of the hypothesis that they are normal; NaN for fewer than three, or all equal.
        mean_signed_s: mean of prediction minus truth.
    """

    count: int
    percentiles_s: tuple[float, ...]
    shapiro_p: float
    mean_signed_s: float

    @property
    def median_s(self) -> float:
        """The middle one."""
        return self.percentiles_s[PERCENTILES.index(50.0)]


def error_summary(predicted_s: FloatArray, truth_s: FloatArray) -> ErrorSummary:
    """Summarise errors of one prediction (N,) for each walk; raises WalkingError for none."""
    from scipy import stats

    if not len(truth_s) or predicted_s.shape != truth_s.shape:
        raise WalkingError(
            f"Errors of {predicted_s.shape} predictions for {truth_s.shape} walks make no summary."
        )
    signed = predicted_s - truth_s
    errors = np.abs(signed)
    p = np.nan
    if len(errors) >= 3 and np.ptp(errors) > 0.0:
        # Its p is only approximate beyond 5000 values, and says zero there anyway.
        p = float(stats.shapiro(errors[:5000]).pvalue)
    percentiles = tuple(float(value) for value in np.percentile(errors, PERCENTILES))
    return ErrorSummary(len(errors), percentiles, p, float(signed.mean()))


@dataclass(frozen=True)
class Comparison:
    """Two models on the same walks, by Wilcoxon's signed-rank test.

    Attributes:
        first, second: their names.
        p: two-sided.
        rank_biserial: positive where the first errs more.
        power: chance to find an effect as large as seen, see `signed_rank_power`.
        difference_s: mean of first minus second.
        ties: walks on which both err alike.
    """

    first: str
    second: str
    p: float
    rank_biserial: float
    power: float
    difference_s: float
    ties: int


def comparison(names: tuple[str, str], first_s: FloatArray, second_s: FloatArray) -> Comparison:
    """Compare errors, or scores, (N,) of two models walk by walk."""
    from app.science.statistics import signed_rank

    test = signed_rank(first_s, second_s)
    apart = first_s - second_s
    spread = float(apart.std(ddof=1)) if len(apart) > 1 else 0.0
    effect = float(apart.mean()) / spread if spread > 0.0 else 0.0
    power = signed_rank_power(len(apart), effect)
    mean = float(apart.mean())
    return Comparison(*names, test.p, test.rank_biserial, power, mean, test.n_zero)


def signed_rank_power(pairs: int, effect: float, alpha: float = ALPHA) -> float:
    """Power of the two-sided signed-rank test, as G*Power computes it (A.R.E. method).

    As of a paired t test with EFFICIENCY times as many pairs. Power computed from the effect seen
    says no more than p does; the paper prints it, so it stands beside the paper's.

    Args:
        pairs: N.
        effect: mean difference over the standard deviation of differences.
        alpha: of the test.
    """
    from scipy import special

    usable = pairs * EFFICIENCY
    if usable <= 1.0:
        return alpha
    freedom, off_centre = usable - 1.0, abs(effect) * np.sqrt(usable)
    critical = float(special.stdtrit(freedom, 1.0 - alpha / 2.0))
    beyond = 1.0 - float(special.nctdtr(freedom, off_centre, critical))
    below = float(special.nctdtr(freedom, off_centre, -critical))
    total = beyond + (0.0 if np.isnan(below) else below)
    return float(min(1.0, max(alpha, total)))


def mean_of(values: Sequence[float]) -> float:
    """Mean of some numbers, NaN of none."""
    return float(np.mean(values)) if len(values) else float("nan")
