"""Tests and estimates of a fitted mixed model: coefficients, terms, marginal means, contrasts.

Every estimate is a row L of weights on the fixed effects: L beta has the variance L C L', which is
itself estimated. Satterthwaite's method gives it the degrees of freedom of the chi-square
distribution with the same mean and variance,

    df = 2 (L C L')^2 / (g' A g),   g_k = L dC/dphi_k L',   A = 2 H^-1,

H the Hessian of the REML criterion over the variances phi. Several rows together, the F test of a
term, are transformed to independent ones, each with its df, whose F distributions are matched in
the mean (Fai and Cornelius 1996). In a balanced design these are the exact degrees of freedom of
the analysis of variance. With few participants and unbalanced designs the method is approximate.

Confidence intervals are for a single estimate each; Holm's correction is over the contrasts of one
call, separately within each level of `by`.

Sources: Giesbrecht and Burns 1985, Biometrics 41, 477; Kuznetsova, Brockhoff and Christensen 2017,
J Stat Softw 82(13); Holm 1979, Scand J Stat 6, 65.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import fdtrc, stdtr, stdtrit

from app.science.statistics.arrays import FloatArray
from app.science.statistics.mixed.design import marginal_weights, pairs_of, term_contrasts
from app.science.statistics.mixed.model import MixedModel
from app.science.statistics.pairwise import holm

DF_METHOD = "Satterthwaite"
_LEVEL = 0.95
_RANK_SHARE = 1e-9


@dataclass(frozen=True)
class Estimate:
    """One estimate from the model, in units of the measure.

    Attributes:
        estimate, se: the estimate and its standard error.
        df: Satterthwaite's degrees of freedom.
        t, p: two-sided test that it is zero.
        low, high: 95 % confidence interval.
    """

    estimate: float
    se: float
    df: float
    t: float
    p: float
    low: float
    high: float


@dataclass(frozen=True)
class FixedEffect:
    """A coefficient and its name, for instance `latency[125]`: that level minus the reference."""

    name: str
    value: Estimate


@dataclass(frozen=True)
class TermTest:
    """F test that a term has no effect (type III, over marginal means).

    Attributes:
        term: `latency`, `limb`, `latency:limb`, or a covariate.
        f: the statistic.
        df_term, df_error: numerator and (Satterthwaite's) denominator degrees of freedom.
        p: the p value from the F distribution.
    """

    term: str
    f: float
    df_term: int
    df_error: float
    p: float


@dataclass(frozen=True)
class MarginalMean:
    """The mean of a level, with equal weights for all combinations of the other factors' levels."""

    level: str
    within: str
    value: Estimate


@dataclass(frozen=True)
class Contrast:
    """The difference `a` minus `b`, within a level of another factor if `within` is not empty.

    `p_holm` is corrected over all contrasts of the same `within`.
    """

    a: str
    b: str
    within: str
    value: Estimate
    p_holm: float


def fixed_effects(model: MixedModel) -> tuple[FixedEffect, ...]:
    """Return every coefficient, the intercept first."""
    rows = np.eye(len(model.design.names))
    names = model.design.names
    return tuple(
        FixedEffect(name, estimate(model, row)) for name, row in zip(names, rows, strict=True)
    )


def term_tests(model: MixedModel) -> tuple[TermTest, ...]:
    """Return an F test for each term of the design."""
    return tuple(term_test(model, term) for term in model.design.terms)


def term_test(model: MixedModel, term: str) -> TermTest:
    """Return the F test of one term; if unknown, raise ModelError listing the terms."""
    rows = term_contrasts(model.design, term)
    covariance = rows @ model.restricted.covariance @ rows.T
    sizes, directions = np.linalg.eigh(covariance)
    kept = sizes > _RANK_SHARE * sizes.max()
    rotated = directions[:, kept].T @ rows
    values = rotated @ model.restricted.beta
    f = float(np.mean(values**2 / sizes[kept]))
    error = _joined_df([degrees_of_freedom(model, row) for row in rotated])
    count = int(kept.sum())
    return TermTest(term, f, count, error, float(fdtrc(count, error, f)))


def marginal_means(model: MixedModel, factor: str, by: str = "") -> tuple[MarginalMean, ...]:
    """Return the marginal mean of each level of `factor`, within each level of `by` if given.

    Raises:
        ModelError: there is no such factor.
    """
    return tuple(
        MarginalMean(level, within, estimate(model, row))
        for within, rows in marginal_weights(model.design, factor, by).items()
        for level, row in rows.items()
    )


def contrasts(
    model: MixedModel, factor: str, by: str = "", against: str = ""
) -> tuple[Contrast, ...]:
    """Return differences of marginal means, with Holm's correction.

    Args:
        model: the fitted model.
        factor: the factor whose levels are compared.
        by: another factor, within each level of which they are compared.
        against: a level with which all others are compared; all pairs if empty.

    Raises:
        ModelError: there is no such factor or level.
    """
    pairs = pairs_of(model.design, factor, against)
    found: list[Contrast] = []
    for within, rows in marginal_weights(model.design, factor, by).items():
        values = [estimate(model, rows[a] - rows[b]) for a, b in pairs]
        corrected = holm([value.p for value in values])
        found += [
            Contrast(a, b, within, value, p)
            for (a, b), value, p in zip(pairs, values, corrected, strict=True)
        ]
    return tuple(found)


def estimate(model: MixedModel, row: FloatArray) -> Estimate:
    """Return estimate, test and interval of `row` (p,) times the fixed effects."""
    value = float(row @ model.restricted.beta)
    se = float(np.sqrt(row @ model.restricted.covariance @ row))
    df = degrees_of_freedom(model, row)
    t = value / se
    half = float(stdtrit(df, (1.0 + _LEVEL) / 2.0)) * se
    p = 2.0 * float(stdtr(df, -abs(t)))
    return Estimate(value, se, df, t, p, value - half, value + half)


def degrees_of_freedom(model: MixedModel, row: FloatArray) -> float:
    """Return Satterthwaite's degrees of freedom of `row` (p,) times the fixed effects."""
    found = model.restricted
    variance = float(row @ found.covariance @ row)
    slope = np.einsum("p,kpq,q->k", row, found.slopes, row)
    spread = 2.0 * float(slope @ np.linalg.pinv(found.hessian, hermitian=True) @ slope)
    if spread <= 0.0:
        # Not at an optimum: use the smallest possible df, which gives the widest interval.
        return 1.0
    return 2.0 * variance**2 / spread


def _joined_df(each: list[float]) -> float:
    """Return the denominator df of the mean of squared t statistics with `each` df."""
    if len(each) == 1 or np.ptp(each) < 1e-8 * each[0]:
        return each[0]
    expected = sum(df / (df - 2.0) for df in each if df > 2.0)
    return 2.0 * expected / (expected - len(each)) if expected > len(each) else 2.0
