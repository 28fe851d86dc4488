"""The probability of each answer and its derivatives, for the likelihood of a cumulative model.

An observation with predictor t is in category k if a latent variable falls between two thresholds:
p = F(upper - t) - F(lower - t), with F the logistic or the normal distribution, and lower and upper
minus and plus infinity at the ends of the scale. Both make log p concave in t, so its mode over a
participant's effect is unique and Newton's method finds it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.special import expit, ndtr

from app.science.statistics.arrays import FloatArray

Link = Literal["logit", "probit"]
_SMALLEST = 1e-300
_DENSITY_AT_ZERO = 1.0 / np.sqrt(2.0 * np.pi)
_FAR = 40.0
"""Beyond this both distributions are 0 or 1 in double precision, and densities are 0."""


@dataclass(frozen=True, eq=False)
class Slopes:
    """log p and its derivatives, each of the shape of the predictor.

    Attributes:
        log_p: the logarithm of the probability of the given answer.
        t, tt, ttt: derivatives by the predictor.
        upper, upper_t, upper_tt: derivative by the upper threshold, and its derivatives by the
            predictor.
        lower, lower_t, lower_tt: the same for the lower threshold.
    """

    log_p: FloatArray
    t: FloatArray
    tt: FloatArray
    ttt: FloatArray
    upper: FloatArray
    upper_t: FloatArray
    upper_tt: FloatArray
    lower: FloatArray
    lower_t: FloatArray
    lower_tt: FloatArray


def log_chance(link: Link, upper: FloatArray, lower: FloatArray) -> tuple[FloatArray, ...]:
    """Return log p and its first two derivatives by the predictor.

    Arguments are thresholds minus predictor, which are infinite at the ends of the scale.
    """
    density = _DENSITIES[link]
    p = _between(link, upper, lower)
    f1, d1, _ = density(upper)
    f2, d2, _ = density(lower)
    t = (f2 - f1) / p
    return np.log(p), t, (d1 - d2) / p - t * t


def slopes(link: Link, upper: FloatArray, lower: FloatArray) -> Slopes:
    """Return log p and all derivatives, given thresholds minus predictor.

    Thresholds are infinite at the ends of the scale.
    """
    density = _DENSITIES[link]
    p = _between(link, upper, lower)
    f1, d1, e1 = (part / p for part in density(upper))
    f2, d2, e2 = (part / p for part in density(lower))
    t, first, second = f2 - f1, d1 - d2, e2 - e1
    tt = first - t * t
    upper_t = -d1 - f1 * t
    lower_t = d2 + f2 * t
    return Slopes(
        log_p=np.log(p),
        t=t,
        tt=tt,
        ttt=second - 3.0 * t * first + 2.0 * t**3,
        upper=f1,
        upper_t=upper_t,
        upper_tt=e1 + d1 * t - upper_t * t - f1 * tt,
        lower=-f2,
        lower_t=lower_t,
        lower_tt=-e2 - d2 * t - lower_t * t + f2 * tt,
    )


def _between(link: Link, upper: FloatArray, lower: FloatArray) -> FloatArray:
    """Return F(upper) - F(lower), computed in the tail in which neither is close to 1."""
    cumulative = expit if link == "logit" else ndtr
    mirrored = lower > 0.0
    high = np.where(mirrored, -lower, upper)
    low = np.where(mirrored, -upper, lower)
    return np.maximum(cumulative(high) - cumulative(low), _SMALLEST)


def _logistic(at: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    below = expit(at)
    density = below * expit(-at)
    lean = 1.0 - 2.0 * below
    return density, density * lean, density * (lean * lean - 2.0 * density)


def _normal(at: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    near = np.clip(at, -_FAR, _FAR)
    density = _DENSITY_AT_ZERO * np.exp(-0.5 * near * near)
    return density, -near * density, (near * near - 1.0) * density


_DENSITIES: dict[Link, Callable[[FloatArray], tuple[FloatArray, FloatArray, FloatArray]]] = {
    "logit": _logistic,
    "probit": _normal,
}
"""The density of each link and its first two derivatives."""
