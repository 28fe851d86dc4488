"""Maximise the restricted likelihood of a mixed model.

statsmodels estimates the variances of a model with random intercepts. With slopes it often stops
short of the optimum, most of all if the best variance is zero or the correlation 1, which is common
with a dozen participants; then its fit with intercepts alone is the start of a search of our own.
That search varies the Cholesky factor of G and log sigma, which have no boundary (G = L L' is never
negative), with the analytic gradient. If the variances are positive, Newton's method completes it,
because degrees of freedom need more precision than estimates.
"""

import warnings
from dataclasses import dataclass

import numpy as np
import scipy.optimize

from app.science.statistics.arrays import FloatArray
from app.science.statistics.mixed.likelihood import Restricted, Rows, restricted_likelihood

_SINGULAR_SHARE = 1e-5
"""A variance below this share of the residual variance counts as zero."""
_START_SHARE = 0.1
_DECREMENT_LIMIT = 1e-4
"""How far the criterion may be above its minimum; too little to affect any test."""
_NEWTON_STEPS = 10
_ROUNDING = 1e-10
_NOT_AT_MAXIMUM = (
    "The search for the variances ended before it reached the maximum of the likelihood."
)
_SINGULAR = (
    "A variance of the random effects is estimated as zero, or they are perfectly correlated: the "
    "observations do not support all of them."
)


@dataclass(frozen=True, eq=False)
class Found:
    """The result of the search: G (k, k), sigma^2, and the likelihood there.

    `restricted` leaves out random effects without variance.
    """

    g: FloatArray
    variance: float
    restricted: Restricted
    converged: bool
    singular: bool
    messages: tuple[str, ...]


def search(rows: Rows) -> Found:
    """Estimate the variances of a mixed model."""
    g, variance, failure = _by_statsmodels(Rows(rows.y, rows.x, rows.z[:, :1], rows.codes))
    if rows.z.shape[1] > 1:
        g, variance = _improved(rows, g, variance)
    kept, own, back = _without_zero_variances(rows, g, variance)
    own, variance, found = _refined(kept, own, variance)
    at_maximum = abs(found.decrement) < _DECREMENT_LIMIT
    singular = len(own) < len(g)
    problems = (
        (failure, bool(failure)),
        (_NOT_AT_MAXIMUM, not at_maximum and not failure),
        (_SINGULAR, singular),
    )
    return Found(
        g=back @ own @ back.T,
        variance=variance,
        restricted=found,
        converged=at_maximum and not failure,
        singular=singular,
        messages=tuple(text for text, applies in problems if applies),
    )


def _by_statsmodels(rows: Rows) -> tuple[FloatArray, float, str]:
    """Return G, sigma^2 and the reason if the search failed; computed in units of order one."""
    # statsmodels takes a second to load, which a server that never fits should not spend.
    from statsmodels.regression.mixed_linear_model import MixedLM

    scale, widths = _units(rows)
    with warnings.catch_warnings():
        # It warns of every zero variance; the relevant checks follow afterwards.
        warnings.simplefilter("ignore")
        try:
            model = MixedLM(
                (rows.y - rows.y.mean()) / scale, rows.x, rows.codes, exog_re=rows.z / widths
            )
            fit = model.fit(reml=True)
        except (np.linalg.LinAlgError, ValueError) as error:
            nothing = np.zeros((len(widths), len(widths)))
            return nothing, _residual_variance(rows), f"The variances were not found: {error}."
    g = scale**2 * np.asarray(fit.cov_re, dtype=np.float64) / np.outer(widths, widths)
    return g, scale**2 * float(fit.scale), ""


def _improved(rows: Rows, g: FloatArray, variance: float) -> tuple[FloatArray, float]:
    """Take quasi-Newton steps from the G of intercepts alone, in units of order one."""
    size, (scale, widths) = rows.z.shape[1], _units(rows)
    unit = Rows((rows.y - rows.y.mean()) / scale, rows.x, rows.z / widths, rows.codes)
    at = np.tril_indices(size)
    # By symmetry, each element off the diagonal occurs twice in the sum.
    halves = np.where(at[0] == at[1], 1.0, 0.5)

    def factor_of(free: FloatArray) -> FloatArray:
        lower = np.zeros((size, size))
        lower[at] = free[:-1]
        return lower

    def objective(free: FloatArray) -> tuple[float, FloatArray]:
        lower, square = factor_of(free), float(np.exp(2.0 * np.clip(free[-1], -20.0, 20.0)))
        found = restricted_likelihood(unit, lower @ lower.T, square)
        by_g = factor_of(np.append(halves * found.gradient[:-1], 0.0))
        by_g = by_g + np.tril(by_g, -1).T
        by_lower = (2.0 * by_g @ lower)[at]
        return found.criterion, np.append(by_lower, 2.0 * square * found.gradient[-1])

    spread = np.full(size, _START_SHARE * variance)
    spread[0] += g[0, 0]
    start = np.diag(np.sqrt(spread) / scale)
    first = np.append(start[at], 0.5 * np.log(variance / scale**2))
    ended = scipy.optimize.minimize(
        objective, first, jac=True, method="BFGS", options={"gtol": 1e-6, "maxiter": 200}
    )
    lower = factor_of(ended.x)
    found = scale**2 * (lower @ lower.T) / np.outer(widths, widths)
    return found, scale**2 * float(np.exp(2.0 * ended.x[-1]))


def _units(rows: Rows) -> tuple[float, FloatArray]:
    """Return the SD of y and the root mean squares of z's columns."""
    return float(rows.y.std()), np.sqrt((rows.z**2).mean(axis=0))


def _residual_variance(rows: Rows) -> float:
    _, squares, rank, _ = np.linalg.lstsq(rows.x, rows.y, rcond=None)
    return float(squares[0]) / (len(rows.y) - int(rank))


def _without_zero_variances(
    rows: Rows, g: FloatArray, variance: float
) -> tuple[Rows, FloatArray, FloatArray]:
    """Return the random effects that have a variance, as independent columns, and their G.

    Also return the matrix (k, r) that transforms their covariance back to that of all random
    effects.
    """
    _, widths = _units(rows)
    sizes, directions = np.linalg.eigh(g * np.outer(widths, widths))
    kept = sizes > _SINGULAR_SHARE * variance
    back = directions[:, kept] / widths[:, np.newaxis]
    return Rows(rows.y, rows.x, rows.z @ back, rows.codes), np.diag(sizes[kept]), back


def _refined(rows: Rows, g: FloatArray, variance: float) -> tuple[FloatArray, float, Restricted]:
    """Take Newton steps near the optimum, because degrees of freedom need more precision."""
    found = restricted_likelihood(rows, g, variance)
    at = np.tril_indices(len(g))
    for _ in range(_NEWTON_STEPS):
        step = np.linalg.lstsq(found.hessian, found.gradient, rcond=None)[0]
        nearer = np.zeros_like(g)
        nearer[at] = g[at] - step[:-1]
        nearer = nearer + np.tril(nearer, -1).T
        if variance <= step[-1] or np.linalg.eigvalsh(nearer).min(initial=1.0) <= 0.0:
            break
        better = restricted_likelihood(rows, nearer, variance - float(step[-1]))
        if not better.criterion <= found.criterion + _ROUNDING:
            break
        g, variance, found = nearer, variance - float(step[-1]), better
        if abs(found.decrement) < _ROUNDING:
            break
    return g, variance, found
