"""One effect of an analysis of variance, and the contrasts from which it is computed.

Every effect is computed from contrast scores of each subject: d orthonormal columns describe how
the levels differ. A subject's d scores have a mean (the effect) and a scatter about it (the error),
so that one formula serves any number of factors.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc, fdtrc

from app.science.statistics.arrays import FloatArray
from app.science.statistics.errors import ConstantData

_ROUNDING = 1e-12
"""Share of the total sum of squares below which an error is taken as rounding."""


@dataclass(frozen=True)
class Effect:
    """One tested effect; sums of squares in the square of the measure's unit, ratios without unit.

    Attributes:
        name: factors joined by ":".
        f, df, df_error, p: the F test under the assumption of sphericity.
        epsilon: Greenhouse and Geisser's estimate, 1/d to 1; 1 with one degree of freedom, and for
            effects between subjects.
        p_gg: p with both degrees of freedom multiplied by epsilon. The one to report.
        partial_eta_squared: SS / (SS + SS of its own error): comparable only within the same
            design.
        generalised_eta_squared: SS / (SS + all SS of subjects and errors): comparable between
            designs (Olejnik and Algina 2003; Bakeman 2005).
        mauchly_w, mauchly_p: test of sphericity; NaN with fewer than two degrees of freedom or too
            few subjects. A small p means that sphericity does not hold, a large one means little.
    """

    name: str
    f: float
    df: float
    df_error: float
    p: float
    epsilon: float
    p_gg: float
    ss: float
    ss_error: float
    partial_eta_squared: float
    generalised_eta_squared: float
    mauchly_w: float
    mauchly_p: float


@dataclass(frozen=True)
class Part:
    """An effect before it is tested: SS and error SS, with the error's covariance."""

    name: str
    ss: float
    ss_error: float
    df: int
    df_error: int
    covariance: FloatArray
    within: bool = True


def contrasts(levels: int) -> FloatArray:
    """Return orthonormal contrasts of (levels, levels - 1): Helmert's, each column of length 1."""
    columns = np.zeros((levels, levels - 1))
    for place in range(1, levels):
        columns[:place, place - 1] = 1.0
        columns[place, place - 1] = -float(place)
    lengths: FloatArray = np.sqrt(np.square(columns).sum(axis=0))
    return columns / lengths


def tested_effect(part: Part, ss_spread: float) -> Effect:
    """Test an effect; `ss_spread` is the sum of all SS of subjects and errors in the design.

    Raises ConstantData if there is no error to test against.
    """
    if part.ss_error <= _ROUNDING * (part.ss + ss_spread):
        raise ConstantData(
            f"{part.name}: every subject differs between the levels by the same amount, so there is"
            " no error to test against."
        )
    f = (part.ss / part.df) / (part.ss_error / part.df_error)
    epsilon = greenhouse_geisser(part.covariance) if part.within else 1.0
    mauchly_w, mauchly_p = math.nan, math.nan
    if part.within:
        freedom = part.df_error // part.covariance.shape[0]
        mauchly_w, mauchly_p = mauchly(part.covariance, freedom)
    return Effect(
        name=part.name,
        f=f,
        df=part.df,
        df_error=part.df_error,
        p=float(fdtrc(part.df, part.df_error, f)),
        epsilon=epsilon,
        p_gg=float(fdtrc(part.df * epsilon, part.df_error * epsilon, f)),
        ss=part.ss,
        ss_error=part.ss_error,
        partial_eta_squared=part.ss / (part.ss + part.ss_error),
        generalised_eta_squared=part.ss / (part.ss + ss_spread),
        mauchly_w=mauchly_w,
        mauchly_p=mauchly_p,
    )


def greenhouse_geisser(covariance: FloatArray) -> float:
    """Return epsilon of the (d, d) covariance of orthonormal contrasts: tr(S)^2 / (d tr(S^2)).

    1 if all contrasts vary equally and independently (sphericity), 1/d at worst. Greenhouse and
    Geisser 1959, Psychometrika 24:95-112.
    """
    d = covariance.shape[0]
    if d == 1:
        return 1.0
    trace = float(np.trace(covariance))
    return float(trace * trace / (d * float(np.square(covariance).sum())))


def mauchly(covariance: FloatArray, freedom: int) -> tuple[float, float]:
    """Return Mauchly's W = det(S) / (tr(S) / d)^d and its p, by Box's second-order approximation.

    Args:
        covariance: (d, d) covariance of orthonormal contrasts, on `freedom` degrees of freedom.
        freedom: subjects minus groups; below d, W is undefined and both results are NaN.

    R and pingouin use the number of levels, not of contrasts, in the last term of p.

    Mauchly 1940, Ann. Math. Stat. 11:204-209; Anderson 2003, section 10.7.
    """
    d = covariance.shape[0]
    if d < 2 or freedom < d:
        return math.nan, math.nan
    w = float(np.linalg.det(covariance)) / (float(np.trace(covariance)) / d) ** d
    if w <= 0.0:
        return 0.0, 0.0
    w = min(w, 1.0)
    scale = 1.0 - (2.0 * d * d + d + 2.0) / (6.0 * d * freedom)
    second = (d + 2) * (d - 1) * (d - 2) * (2.0 * d**3 + 6.0 * d * d + 3.0 * d + 2.0)
    second /= 288.0 * (freedom * d * scale) ** 2
    chi, df = -freedom * scale * math.log(w), d * (d + 1) / 2 - 1
    p = float(chdtrc(df, chi))
    return w, min(1.0, max(0.0, p + second * (float(chdtrc(df + 4, chi)) - p)))
