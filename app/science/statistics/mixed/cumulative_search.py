"""Maximise the likelihood of ordinal answers, and compute standard errors.

Thresholds must stay in order, so the search varies the first one and the logarithms of the gaps
between them; the other parameters are unconstrained. The participants' SD may cross zero, where the
likelihood is symmetric. BFGS uses the analytic gradient; Newton steps with the Hessian, from
differences of the gradient, complete the search and give standard errors. If the SD is near zero,
the model without participants is tried too, since zero is the lower bound.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy.optimize
from scipy.special import logit, ndtri

from app.science.statistics.arrays import FloatArray
from app.science.statistics.mixed.cumulative_likelihood import Answers, Parameters, log_likelihood
from app.science.statistics.mixed.cumulative_links import Link

_NEAR_ZERO_SD = 0.05
_DECREMENT_LIMIT = 1e-6
_FAR_EFFECT = 15.0
"""On the latent scale; odds of three million to one mean that no finite estimate exists."""
_NO_ESTIMATE = (
    "An effect has no finite estimate: the answers of a condition are all at one end of the scale, "
    "or participants hardly ever vary theirs."
)
_NEWTON_STEPS = 3
_STEP = 1e-4


@dataclass(frozen=True, eq=False)
class Found:
    """The result of the search.

    Attributes:
        at: the estimated parameters.
        errors: standard errors of thresholds, effects and sd; NaN where there is none.
        covariance: the covariance of the effects (p, p); NaN where there is none.
        log_likelihood, gradient: the log-likelihood and its gradient at the estimates; the gradient
            by thresholds, effects and sd.
        converged, messages: whether it is an optimum, and what else to report.
    """

    at: Parameters
    errors: FloatArray
    covariance: FloatArray
    log_likelihood: float
    gradient: FloatArray
    converged: bool
    messages: tuple[str, ...]


def search(answers: Answers, link: Link, nodes: int, *, mixed: bool) -> Found:
    """Find the maximum of the likelihood; without `mixed` the sd stays zero."""
    if not mixed:
        return _finish(answers, link, 1, _climb(answers, link, 1, _start(answers, link)))
    found = _climb(answers, link, nodes, _start(answers, link)._replace(sd=1.0))
    if found.sd < _NEAR_ZERO_SD:
        without = _climb(answers, link, nodes, found._replace(sd=0.0))
        if _value(answers, link, nodes, without) >= _value(answers, link, nodes, found) - 1e-9:
            found = without
    ended = _finish(answers, link, nodes, found)
    if ended.at.sd > 0.0:
        return ended
    message = "Participants do not differ: their variance is estimated as zero."
    return replace(ended, messages=(*ended.messages, message))


def _start(answers: Answers, link: Link) -> Parameters:
    """Return the thresholds of a model without effects, as the start of the search."""
    shares = np.cumsum(np.bincount(answers.categories, minlength=answers.count))[:-1]
    quantile = logit if link == "logit" else ndtri
    return Parameters(quantile(shares / len(answers.categories)), np.zeros(answers.x.shape[1]), 0.0)


def _value(answers: Answers, link: Link, nodes: int, at: Parameters) -> float:
    return log_likelihood(answers, at, link, nodes)[0]


def _climb(answers: Answers, link: Link, nodes: int, start: Parameters) -> Parameters:
    """Run BFGS over first threshold, log gaps, effects and, unless it starts at zero, sd."""
    inner, size = len(start.thresholds), len(start.thresholds) + len(start.beta)
    mixed = start.sd > 0.0

    def unpack(free: FloatArray) -> Parameters:
        gaps = np.exp(np.clip(free[1:inner], -30.0, 30.0))
        thresholds = free[0] + np.concatenate(([0.0], np.cumsum(gaps)))
        return Parameters(thresholds, free[inner:size], float(free[size]) if mixed else 0.0)

    def objective(free: FloatArray) -> tuple[float, FloatArray]:
        at = unpack(free)
        value, gradient = log_likelihood(answers, at, link, nodes)
        # Each gap shifts its threshold and all higher ones.
        by_threshold = np.cumsum(gradient[:inner][::-1])[::-1].copy()
        by_threshold[1:] *= np.diff(at.thresholds)
        moved = np.concatenate((by_threshold, gradient[inner : len(free)]))
        return -value, -moved

    first = np.concatenate(
        (
            start.thresholds[:1],
            np.log(np.diff(start.thresholds)),
            start.beta,
            [start.sd] if mixed else [],
        )
    )
    ended = scipy.optimize.minimize(
        objective, first, jac=True, method="BFGS", options={"gtol": 1e-5, "maxiter": 300}
    )
    at = unpack(ended.x)
    return at._replace(sd=abs(at.sd))


def _finish(answers: Answers, link: Link, nodes: int, at: Parameters) -> Found:
    """Take Newton steps, compute standard errors, and check that the result is an optimum."""
    free = len(at.thresholds) + len(at.beta) + (at.sd > 0.0)
    value, gradient = log_likelihood(answers, at, link, nodes)
    information = _information(answers, link, nodes, at, free)
    for _ in range(_NEWTON_STEPS):
        step = _newton_step(information, gradient[:free])
        nearer = _moved(at, step)
        if np.any(np.diff(nearer.thresholds) <= 0.0) or nearer.sd < 0.0:
            break
        higher, slope = log_likelihood(answers, nearer, link, nodes)
        if higher < value:
            break
        at, value, gradient = nearer, higher, slope
    step = _newton_step(information, gradient[:free])
    errors = np.full(len(gradient), np.nan)
    covariance = np.full((free, free), np.nan)
    if np.linalg.eigvalsh(information).min() > 0.0:
        covariance[:] = np.linalg.inv(information)
        errors[:free] = np.sqrt(np.diag(covariance))
    messages = _problems(at, errors, float(gradient[:free] @ step))
    inner = slice(len(at.thresholds), len(at.thresholds) + len(at.beta))
    return Found(at, errors, covariance[inner, inner], value, gradient, not messages, messages)


def _problems(at: Parameters, errors: FloatArray, decrement: float) -> tuple[str, ...]:
    if np.abs(at.beta).max(initial=0.0) > _FAR_EFFECT or at.sd > _FAR_EFFECT:
        return (_NO_ESTIMATE,)
    if np.isnan(errors[0]):
        return (
            "The search did not end at a maximum of the likelihood; there are no standard errors.",
        )
    if decrement > _DECREMENT_LIMIT:
        return ("The search ended before it reached the maximum of the likelihood.",)
    return ()


def _information(answers: Answers, link: Link, nodes: int, at: Parameters, free: int) -> FloatArray:
    """Return minus the Hessian, by central differences of the gradient."""
    found = np.empty((free, free))
    for index in range(free):
        step = np.zeros(free)
        step[index] = _STEP
        forward = log_likelihood(answers, _moved(at, step), link, nodes)[1]
        backward = log_likelihood(answers, _moved(at, -step), link, nodes)[1]
        found[index] = (backward - forward)[:free] / (2.0 * _STEP)
    return 0.5 * (found + found.T)


def _moved(at: Parameters, step: FloatArray) -> Parameters:
    inner, size = len(at.thresholds), len(at.thresholds) + len(at.beta)
    sd = at.sd + float(step[size]) if len(step) > size else at.sd
    return Parameters(at.thresholds + step[:inner], at.beta + step[inner:size], sd)


def _newton_step(information: FloatArray, gradient: FloatArray) -> FloatArray:
    """Return the Newton step; the shortest one if the information is singular."""
    return np.asarray(np.linalg.lstsq(information, gradient, rcond=None)[0], dtype=np.float64)
