"""The size of the effect of a factor on every measure, on one scale, so that they can be compared.

What is compared are the ends of the factor: the largest latency with the smallest, or the last body
with the first one. The difference is divided by the average of both standard deviations: Cohen's
d_av (Lakens 2013, Front. Psychol. 4:863, equation 10). Unlike d_z it does not grow with the
correlation of repeated values, so it is comparable with studies between participants.
"""

from collections.abc import Iterator

import numpy as np

from app.features.results.analysis.questions.measures import Measure
from app.features.results.analysis.questions.words import mean_interval
from app.features.results.analysis.schemas import EffectView


def effects_of(measure: Measure) -> Iterator[EffectView]:
    """Yield one effect for each limb with at least two participants who have both values.

    Its interval is Student's of the mean difference, divided by the same standard deviation, which
    is taken as known. It is missing where all differences are equal; the standardised effect is
    missing where nothing varies.
    """
    first, last = measure.levels[0], measure.levels[-1]
    words = measure.factor.words
    for limb in measure.limbs:
        ends = measure.table(limb).iloc[:, [0, -1]].dropna().to_numpy(dtype=np.float64)
        if len(ends) < 2:
            continue
        differences = ends[:, 1] - ends[:, 0]
        found = mean_interval(differences)
        spread = float(ends.std(axis=0, ddof=1).mean())
        low, high = (None, None) if found is None else (found.low, found.high)
        mean = float(differences.mean())
        yield EffectView(
            limb=limb,
            contrast=f"{words(last)} − {words(first)}",
            n=len(ends),
            difference=mean,
            low=low,
            high=high,
            standardised=_over(mean, spread),
            standardised_low=_over(low, spread),
            standardised_high=_over(high, spread),
        )


def _over(value: float | None, spread: float) -> float | None:
    """Return a value in standard deviations; None if there is none or nothing varies."""
    return None if value is None or spread <= 0.0 else value / spread
