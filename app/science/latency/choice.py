"""Which lag it is, where the movement repeats itself.

Whoever walks at one stride a second looks at 1.1 s much as at 0.1 s. Every peak of the correlation
that is nearly as high as the highest is therefore refined, and the blocks decide: a lag at which
the bodies differ clearly more, block by block, is out. If several are left, the data cannot tell,
and the smallest lag that is not negative is taken; the others are handed back to be told.
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
# In squared scales, which are at least 0.1 degrees: below it two lags fit equally well.
_NO_DIFFERENCE = 0.01


def choose(
    comparisons: Sequence[Comparison], correlation: Correlation
) -> tuple[Fit, tuple[float, ...]] | None:
    """Return the fit and the other lags that fit as well; None where no peak lies within."""
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
