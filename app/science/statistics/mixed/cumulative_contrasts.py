"""Differences between levels on the hidden scale of a cumulative model, with Holm's correction.

A level's mean weighs every combination of the other factors' levels alike. With `logit` a
difference is a log odds ratio, with `probit` it is in standard deviations of the hidden value.
Tests are Wald's, by the normal distribution: approximate, and without meaning if the model has not
converged.
"""

from dataclasses import dataclass

import numpy as np
import scipy.stats

from app.science.statistics.holm import holm
from app.science.statistics.mixed.cumulative_model import CumulativeEffect, CumulativeModel
from app.science.statistics.mixed.design import marginal_weights, pairs_of
from app.science.statistics.mixed.terms import ModelError

_LEVEL = 0.95


@dataclass(frozen=True)
class CumulativeContrast:
    """`a` less `b`, within a level of another factor if `within` is not empty.

    `p_holm` is corrected over all contrasts of the same `within`.
    """

    a: str
    b: str
    within: str
    value: CumulativeEffect
    p_holm: float


def cumulative_contrasts(
    model: CumulativeModel, factor: str, by: str = "", against: str = ""
) -> tuple[CumulativeContrast, ...]:
    """Compare the levels of a factor.

    Args:
        model: fitted, with a design.
        factor: whose levels are compared.
        by: another factor, within each level of which they are compared.
        against: a level that all others are compared with; all pairs if empty.

    Raises:
        ModelError: the model has no such factor or level, or no standard errors.
    """
    if model.design is None:
        raise ModelError("The model has thresholds only; there is nothing to compare.")
    if np.isnan(model.covariance).any():
        raise ModelError(f"The model has no standard errors. {' '.join(model.messages)}")
    pairs = pairs_of(model.design, factor, against)
    found: list[CumulativeContrast] = []
    for within, rows in marginal_weights(model.design, factor, by).items():
        # The intercept cancels; thresholds stand in its place.
        values = [_effect(model, f"{a} - {b}", (rows[a] - rows[b])[1:]) for a, b in pairs]
        corrected = holm([value.p for value in values])
        found += [
            CumulativeContrast(a, b, within, value, p)
            for (a, b), value, p in zip(pairs, values, corrected, strict=True)
        ]
    return tuple(found)


def _effect(model: CumulativeModel, name: str, row: np.ndarray) -> CumulativeEffect:
    value = float(row @ [one.estimate for one in model.effects])
    se = float(np.sqrt(row @ model.covariance @ row))
    half = float(scipy.stats.norm.ppf((1.0 + _LEVEL) / 2.0)) * se
    z = value / se
    p = 2.0 * float(scipy.stats.norm.sf(abs(z)))
    return CumulativeEffect(name, value, se, z, p, value - half, value + half)
