"""Powers of the repeated-measures ANOVA that G*Power 3 gives, and the same by simulation."""

from collections.abc import Callable
from typing import Final

import numpy as np

from app.science.pilot import Course, PowerPoint, Results, drawn_courses, power_point
from app.science.statistics import FloatArray, rm_anova

SETS: Final = 4000
PUBLISHED: Final = ((12, 0.14, 0.823), (28, 0.0625 / 1.0625, 0.812))
"""Participants, partial eta squared, and power for three levels that correlate by .5."""


def f_test(values: FloatArray) -> float:
    """Return the p of the uncorrected test."""
    return rm_anova(values).effects[0].p


def greenhouse_geisser(values: FloatArray) -> float:
    """Return the p of the corrected test."""
    return rm_anova(values).effects[0].p_gg


def simulated_power(
    n: int, partial_eta_squared: float, seed: int, p_of: Callable[[FloatArray], float] = f_test
) -> PowerPoint:
    """Return the point of three levels with correlation .5 and an effect of this size."""
    f = np.sqrt(partial_eta_squared / (1.0 - partial_eta_squared))
    effects = np.array([[0.0, 1.0, 2.0]]) * f * np.sqrt(1.5)
    course = Course(effects, effects, 0.0, 0.0, np.sqrt(0.5), 0.0, np.sqrt(0.5))
    orders = np.tile(np.arange(3), (SETS, n, 1))
    results = []
    for at, one in enumerate((course, course.without_effect())):
        levels = drawn_courses(one, orders, np.random.default_rng((seed, at)))[:, :, 0]
        results.append(
            Results(
                np.array([p_of(values) <= 0.05 for values in levels]),
                np.zeros(SETS, dtype=np.bool_),
                (levels[:, :, -1] - levels[:, :, 0]).mean(axis=1),
                np.full(SETS, n),
            )
        )
    effect, null = results
    return power_point(n, effect, null, assumed=float(effects[0, 2]))
