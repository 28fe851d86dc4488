"""Tests of cumulative models: whether a term contributes, and which levels differ.

Twice the difference of the log-likelihoods of a model and of the same model without r of its
parameters is chi-square with r degrees of freedom if these parameters are zero and participants are
many. A main effect is tested without the interactions that contain it (type II), an interaction
together with the main effects. Both models must be fitted to the same answers in the same way.

With a dozen participants the test rejects somewhat too often; the table of error rates gives its
rate in this design.

Levels are compared on the latent scale, with Holm's correction (`cumulative_contrasts`). A level's
mean weights every combination of the other factors' levels equally. With `logit` a difference is a
log odds ratio, with `probit` it is in standard deviations of the latent variable. Tests are Wald's,
by the normal distribution: approximate, and meaningless if the model has not converged.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc, ndtr, ndtri

from app.science.statistics.arrays import IntArray
from app.science.statistics.mixed.cumulative_links import Link
from app.science.statistics.mixed.cumulative_model import (
    CumulativeEffect,
    CumulativeModel,
    fit_cumulative_model,
)
from app.science.statistics.mixed.design import Design, build_design, marginal_weights, pairs_of
from app.science.statistics.mixed.terms import Label, ModelError
from app.science.statistics.pairwise import holm


@dataclass(frozen=True)
class LikelihoodRatio:
    """The likelihood-ratio test of two nested models.

    Attributes:
        statistic: twice the difference of the log-likelihoods.
        df: parameters that the smaller model lacks.
        p: the p value from the chi-square distribution.
        converged: whether both fits have converged; otherwise the test is meaningless.
        method: a description of how the likelihoods were computed.
    """

    statistic: float
    df: int
    p: float
    converged: bool
    method: str


@dataclass(frozen=True)
class CumulativeTermTest:
    """The likelihood-ratio test of one term of a model."""

    term: str
    test: LikelihoodRatio


def likelihood_ratio(small: CumulativeModel, large: CumulativeModel) -> LikelihoodRatio:
    """Test whether the larger model fits significantly better.

    Raises:
        ModelError: the models differ in more than their terms, or the larger is not larger.
    """
    shared = ("link", "nodes", "observations", "participants", "levels")
    different = [name for name in shared if getattr(small, name) != getattr(large, name)]
    if different:
        raise ModelError(f"The models differ in {', '.join(different)}; only terms may.")
    df = large.parameters - small.parameters
    if df < 1:
        raise ModelError("The second model must have more parameters than the first.")
    statistic = max(0.0, 2.0 * (large.log_likelihood - small.log_likelihood))
    return LikelihoodRatio(
        statistic=statistic,
        df=df,
        p=float(chdtrc(df, statistic)),
        converged=small.converged and large.converged,
        method=method_of(large),
    )


def cumulative_term_tests(
    answers: Sequence[int] | IntArray,
    participants: Sequence[Label],
    design: Design,
    *,
    terms: Sequence[str] = (),
    link: Link = "logit",
    nodes: int = 1,
) -> tuple[CumulativeTermTest, ...]:
    """Test terms of a design by likelihood ratio.

    Args:
        answers, participants, link, nodes: the same as for `fit_cumulative_model`.
        design: the design with all terms.
        terms: the terms to test; all of them if empty.

    Raises:
        ModelError: a term is unknown, or the answers cannot be modelled.
    """
    unknown = [term for term in terms if term not in design.terms]
    if unknown:
        raise ModelError(f"There is no term {unknown[0]}; valid: {', '.join(design.terms)}.")
    found = []
    for term in terms or design.terms:
        large = _without_products_of(design, term)
        fits = (
            fit_cumulative_model(answers, participants, each, link=link, nodes=nodes)
            for each in (without_term(large, term), large)
        )
        found.append(CumulativeTermTest(term, likelihood_ratio(*fits)))
    return tuple(found)


def method_of(model: CumulativeModel) -> str:
    """Describe how the likelihood was computed."""
    if model.nodes > 1:
        return f"adaptive Gauss-Hermite quadrature, {model.nodes} nodes"
    return "Laplace approximation" if model.nodes else "no random effect"


def without_term(design: Design, term: str) -> Design | None:
    """Return the design without one term; None if nothing is left."""
    factors = [each for each in design.factors if each.name != term]
    covariates = [each for each in design.covariates if each.name != term]
    products = [names for names in design.interactions if ":".join(names) != term]
    return build_design(factors, covariates, products) if factors or covariates else None


def _without_products_of(design: Design, term: str) -> Design:
    """Return the design without the interactions that strictly contain the term."""
    factors = set(term.split(":"))
    products = [names for names in design.interactions if not factors < set(names)]
    return build_design(design.factors, design.covariates, products)


_LEVEL = 0.95


@dataclass(frozen=True)
class CumulativeContrast:
    """The difference `a` minus `b`, within a level of another factor if `within` is not empty.

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
    """Compare the levels of a factor on the latent scale.

    Args:
        model: a fitted model with a design.
        factor: the factor whose levels are compared.
        by: another factor, within each level of which they are compared.
        against: a level with which all others are compared; all pairs if empty.

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
        # The intercept cancels; the model has thresholds instead.
        values = [_effect(model, f"{a} - {b}", (rows[a] - rows[b])[1:]) for a, b in pairs]
        corrected = holm([value.p for value in values])
        found += [
            CumulativeContrast(a, b, within, value, p)
            for (a, b), value, p in zip(pairs, values, corrected, strict=True)
        ]
    return tuple(found)


def _effect(model: CumulativeModel, name: str, row: np.ndarray) -> CumulativeEffect:
    value = float(row @ [each.estimate for each in model.effects])
    se = float(np.sqrt(row @ model.covariance @ row))
    half = float(ndtri((1.0 + _LEVEL) / 2.0)) * se
    z = value / se
    p = 2.0 * float(ndtr(-abs(z)))
    return CumulativeEffect(name, value, se, z, p, value - half, value + half)
