"""Cumulative link models: regression for ordinal answers, which are not treated as numbers.

An answer depends on a latent variable, which thresholds divide into the categories of the scale:

    P(answer <= k) = F(theta_k - x beta - u),    u ~ N(0, sigma^2) for each participant,

F logistic (`logit`) or normal (`probit`). Thresholds are free but increasing. A positive effect
moves answers up the scale; with `logit`, exp(beta) is the factor by which the odds of answering
above any threshold grow. With u it is a mixed model (CLMM), without it the plain one (CLM), which
treats all answers as independent and is wrong for repeated measures: it is included for comparison.

The likelihood is Laplace's (`nodes` 1) or by adaptive Gauss-Hermite quadrature
(`cumulative_likelihood`). Standard errors are from the observed information: differences of the
analytic gradient at the optimum. Tests of single effects are Wald's; prefer likelihood-ratio tests
(`cumulative_tests`). Both are approximate with a dozen participants.

Categories that nobody chose have no threshold: they are left out, and listed in the result. If
every answer of a condition is at the end of the scale, its effect has no finite estimate; then the
fit is reported as not converged.

Sources: Agresti 2010, Analysis of Ordinal Categorical Data; Christensen 2019, `ordinal` for R.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.special import ndtr, ndtri

from app.science.statistics.arrays import FloatArray, IntArray
from app.science.statistics.mixed.cumulative_likelihood import Answers
from app.science.statistics.mixed.cumulative_links import Link
from app.science.statistics.mixed.cumulative_search import Found, search
from app.science.statistics.mixed.design import Design
from app.science.statistics.mixed.terms import Label, ModelError, participant_codes

_LEVEL = 0.95
_MOST_NODES = 50
_FEWEST_PARTICIPANTS = 3


@dataclass(frozen=True)
class Threshold:
    """The threshold of the latent variable between two neighbouring categories, such as `2|3`."""

    between: str
    estimate: float
    se: float


@dataclass(frozen=True)
class CumulativeEffect:
    """A coefficient on the latent scale (log odds or standard deviations).

    Attributes:
        name: the name, for instance `latency[125]`: that level minus the reference.
        estimate, se: the estimate and its standard error.
        z, p: Wald's two-sided test that it is zero.
        low, high: 95 % confidence interval.
    """

    name: str
    estimate: float
    se: float
    z: float
    p: float
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class CumulativeModel:
    """A fitted cumulative link (mixed) model.

    Attributes:
        link: distribution of the latent variable.
        nodes: the number of nodes of the quadrature; 1 is Laplace's approximation, 0 a model
            without participants.
        thresholds, effects: the estimated thresholds and effects.
        participant_sd: sigma, on the latent scale; 0 if estimated as zero or not in the model.
        participant_sd_se: the standard error of `participant_sd`; NaN where sigma is 0.
        log_likelihood: the log-likelihood at the optimum.
        parameters: number of estimated parameters.
        observations: number of observations.
        participants: number of participants; 0 in a model without participant effects.
        levels: the categories that were chosen, in order.
        unused_levels: those of the scale that nobody chose.
        converged: whether the search ended at a maximum of the likelihood.
        messages: sentences that a reader of the fit must know; empty if there are none.
        gradient: (parameters,) gradient of the log-likelihood where the search ended.
        design: the design of the effects; None for a model with thresholds only.
        covariance: (p, p) covariance of the effects; NaN without standard errors.
    """

    link: Link
    nodes: int
    thresholds: tuple[Threshold, ...]
    effects: tuple[CumulativeEffect, ...]
    participant_sd: float
    participant_sd_se: float
    log_likelihood: float
    parameters: int
    observations: int
    participants: int
    levels: tuple[int, ...]
    unused_levels: tuple[int, ...]
    converged: bool
    messages: tuple[str, ...]
    gradient: FloatArray
    design: Design | None
    covariance: FloatArray

    @property
    def participant_variance(self) -> float:
        """sigma^2, the variance between participants, as R's `ordinal` prints it."""
        return self.participant_sd**2

    @property
    def aic(self) -> float:
        """Akaike's information criterion."""
        return 2.0 * (self.parameters - self.log_likelihood)


def fit_cumulative_model(
    answers: Sequence[int] | IntArray,
    participants: Sequence[Label] | None,
    design: Design | None,
    *,
    link: Link = "logit",
    nodes: int = 1,
    scale: Sequence[int] | None = None,
) -> CumulativeModel:
    """Fit a cumulative model by maximum likelihood.

    Args:
        answers: N categories as whole numbers, larger is more.
        participants: the participants of the N answers, by name; None treats all answers as
            independent (CLM).
        design: the design of the same N observations; its intercept is dropped in favour of the
            thresholds. None fits thresholds only.
        link: "logit" or "probit".
        nodes: 1 for Laplace, up to 50 for adaptive Gauss-Hermite quadrature; 10 are enough.
        scale: the categories that could be chosen, to report those that were not.

    Raises:
        ModelError: lengths differ, an answer is not on the scale, fewer than two categories were
            chosen, or there are fewer than three participants.
    """
    given = np.asarray(answers)
    levels = _levels(given, scale)
    x = np.empty((len(given), 0)) if design is None else design.matrix[:, 1:]
    names = () if design is None else design.names[1:]
    codes = np.arange(len(given)) if participants is None else participant_codes(participants)
    _check(len(given), len(x), codes, nodes)
    order = np.argsort(codes, kind="stable")
    categories = np.searchsorted(levels, given)[order].astype(np.int64)
    data = Answers(categories, x[order], codes[order], len(levels))
    found = search(data, link, nodes, mixed=participants is not None)
    unused = sorted(set(scale or ()) - set(levels))
    return CumulativeModel(
        link=link,
        nodes=nodes if participants is not None else 0,
        thresholds=_thresholds(levels, found),
        effects=_effects(names, found),
        participant_sd=found.at.sd,
        participant_sd_se=float(found.errors[-1]),
        log_likelihood=found.log_likelihood,
        parameters=len(found.errors) - (participants is None),
        observations=len(given),
        participants=0 if participants is None else data.participants,
        levels=tuple(levels),
        unused_levels=tuple(unused),
        converged=found.converged,
        messages=(*found.messages, *_about(unused)),
        gradient=found.gradient,
        design=design,
        covariance=found.covariance,
    )


def _thresholds(levels: list[int], found: Found) -> tuple[Threshold, ...]:
    names = [f"{low}|{high}" for low, high in pairwise(levels)]
    values = zip(names, found.at.thresholds, found.errors, strict=False)
    return tuple(Threshold(name, float(value), float(se)) for name, value, se in values)


def _effects(names: Sequence[str], found: Found) -> tuple[CumulativeEffect, ...]:
    errors = found.errors[len(found.at.thresholds) : -1]
    half = float(ndtri((1.0 + _LEVEL) / 2.0))
    effects = []
    for name, value, se in zip(names, found.at.beta.tolist(), errors.tolist(), strict=True):
        z = value / se
        p = 2.0 * float(ndtr(-abs(z)))
        low, high = value - half * se, value + half * se
        effects.append(CumulativeEffect(name, value, se, z, p, low, high))
    return tuple(effects)


def _levels(given: IntArray, scale: Sequence[int] | None) -> list[int]:
    if given.ndim != 1 or given.dtype.kind not in "iu":
        raise ModelError("Answers must be a one-dimensional array of whole numbers, none missing.")
    levels: list[int] = np.unique(given).tolist()
    invalid = [level for level in levels if scale is not None and level not in scale]
    if invalid:
        raise ModelError(f"The answer {invalid[0]} is not on the scale {list(scale or ())}.")
    if len(levels) < len(("low", "high")):
        raise ModelError(f"All answers are {levels}: there is no variation to model.")
    return levels


def _check(answers: int, rows: int, codes: IntArray, nodes: int) -> None:
    if not answers == rows == len(codes):
        raise ModelError(
            f"{answers} answers, {len(codes)} participants' names and {rows} rows of the design do "
            "not fit; each observation needs one of each."
        )
    if codes.max() + 1 < _FEWEST_PARTICIPANTS:
        raise ModelError(f"{codes.max() + 1} participants are too few; give three or more.")
    if not 1 <= nodes <= _MOST_NODES:
        raise ModelError(f"The number of quadrature nodes is {nodes}; valid: 1 to {_MOST_NODES}.")


def _about(unused: list[int]) -> tuple[str, ...]:
    if not unused:
        return ()
    listed = ", ".join(str(level) for level in unused)
    return (f"Nobody answered {listed}; the model leaves these categories out.",)
