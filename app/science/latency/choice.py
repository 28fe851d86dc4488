"""Choose the lag where a movement repeats itself, and compute the lag's confidence interval.

For somebody who walks at one stride a second, a lag of 1.1 s fits nearly as well as one of 0.1 s.
Every peak of the correlation that is nearly as high as the highest is therefore refined, and the
blocks decide: a lag at which the bodies differ clearly more, block by block, is rejected. If
several are left, the data cannot decide, and the smallest lag that is not negative is chosen; the
others are returned with it.

The confidence interval follows from how much the blocks of the movement disagree about the lag.
Noise from frame to frame, jitter, dropped frames, a controller that lags more in one posture than
in another: whatever makes single differences deviate also makes the blocks' parts N_b of the
estimating sum scatter, including their dependence from frame to frame. So the error follows from
the blocks alone (Künsch 1989, Annals of Statistics 17:1217), with the jackknife's correction for a
block's influence on the estimate and, where neighbouring blocks deviate in the same direction, with
their product (Newey & West 1987, Econometrica 55:703):

    e_b = (N_b + delta D_b) / (1 - D_b / D),   var = (sum e_b^2 + max(0, sum e_b e_(b+1))) / D^2.

The interval uses Student's t with D^2 / sum D_b^2 - 1 degrees of freedom: a phase in which most of
the movement fell into three blocks counts as three blocks.
"""

import math
from collections.abc import Sequence

import numpy as np

from app.science.latency.correlation import Correlation
from app.science.latency.refinement import Comparison, Fit, misfit, refine
from app.science.latency.stretches import GRID_S
from app.science.rotations import FloatArray

_NEARLY = 0.15
_MOST_PEAKS = 4
_CLEARLY_SE = 3.0
# In units of the squared scale (a scale is at least 0.1 degrees): below it two lags fit equally
# well.
_NO_DIFFERENCE = 0.01


def choose(
    comparisons: Sequence[Comparison], correlation: Correlation
) -> tuple[Fit, tuple[float, ...]] | None:
    """Return the chosen fit and the other lags that fit as well.

    None if the highest correlation is at an end of the range of lags.
    """
    peaks = correlation.peaks(_NEARLY, _MOST_PEAKS)
    fits = [refine(comparisons, float(correlation.lags_s[peak])) for peak in peaks]
    if len(fits) <= 1:
        return (fits[0], ()) if fits else None
    scale = np.min([fit.scale for fit in fits], axis=0)
    misfits = [misfit(comparisons, fit.lag_s, scale) for fit in fits]
    best = min(misfits, key=lambda blocks: float(blocks.mean()))
    left = [fit for fit, own in zip(fits, misfits, strict=True) if not _clearly_worse(own - best)]
    left.sort(key=lambda fit: (fit.lag_s < -GRID_S, abs(fit.lag_s)))
    others = (fit.lag_s for fit in left[1:] if abs(fit.lag_s - left[0].lag_s) > GRID_S)
    return left[0], tuple(sorted(others))


def _clearly_worse(differences: FloatArray) -> bool:
    mean = float(differences.mean())
    if mean <= _NO_DIFFERENCE:
        return False
    if len(differences) < 2:
        return True
    error = float(differences.std(ddof=1)) / math.sqrt(len(differences))
    return mean > _CLEARLY_SE * error


# Linear interpolation between a client's frames shifts its movement by up to 0.02 ms, and a
# browser's clock may be no finer than 0.1 ms: the error is not smaller, however well blocks agree.
_LEAST_HALF_WIDTH_S = 0.00005
_CONFIDENCE = 0.95


def half_width_s(fit: Fit) -> float:
    """Return half the width of the 95 % confidence interval of a fit's lag.

    Infinite if there are too few blocks.
    """
    from scipy.special import stdtrit  # slow to import, and rarely needed

    total = float(fit.bottom.sum())
    share = fit.bottom / total if total > 0.0 else np.ones(1)
    freedom = 1.0 / float(np.sum(share**2)) - 1.0
    if total <= 0.0 or freedom < 1.0 or bool(np.any(share > 0.99)):
        return math.inf
    left = (fit.top - float(fit.top.sum()) * share) / (1.0 - share)
    together = max(0.0, float(np.sum(left[1:] * left[:-1])))
    deviation_s = math.sqrt(float(np.sum(left**2)) + together) / total
    quantile = float(stdtrit(freedom, 0.5 + _CONFIDENCE / 2.0))
    return math.hypot(quantile * deviation_s, _LEAST_HALF_WIDTH_S)
