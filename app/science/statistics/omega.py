"""McDonald's omega: the reliability of a sum whose items load differently on one factor.

One factor is fitted to the covariances of the items: s_ij = l_i l_j for i != j, with loadings l by
least squares over the off-diagonal entries (the estimator called minres or ULS). What is left of an
item's variance is its error, e_i = s_ii - l_i^2. Then

    omega = (sum l)^2 / ((sum l)^2 + sum e),

which is omega total of a one-factor model; equal loadings give Cronbach's alpha. No distribution is
assumed. Its interval is a BCa bootstrap over subjects. It takes many more subjects than a dozen to
be of use; the interval says so.

McDonald 1999, Test Theory; Harman and Jones 1966, Psychometrika 31:351-368.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.science.statistics.arrays import FloatArray
from app.science.statistics.bootstrap import Interval, bootstrap_interval
from app.science.statistics.cronbach import answered
from app.science.statistics.errors import ConstantData, TooFewData

_ROUNDS = 60


@dataclass(frozen=True)
class Omega:
    """Omega of k items answered by n subjects.

    Attributes:
        omega: 0 to 1.
        interval: BCa over subjects.
        loadings: of each item, in the unit of the answers.
        heywood: an item's loading explains more than its variance (the model does not fit, or there
            are too few subjects); its error counts as zero.
        n: subjects with all items; n_left_out: the others (listwise).
        estimator: how loadings were found.
    """

    omega: float
    interval: Interval
    loadings: tuple[float, ...]
    heywood: bool
    n: int
    n_left_out: int
    estimator: str = "one factor, unweighted least squares (minres)"


def mcdonald_omega(
    answers: npt.ArrayLike,
    *,
    rng: np.random.Generator,
    confidence: float = 0.95,
    resamples: int = 1999,
) -> Omega:
    """Return omega of (n subjects, k items), reversed items turned round already; NaN is missing.

    Raises TooFewData for fewer than 3 items (two cannot tell their loadings apart) or 3 complete
    subjects, ConstantData if an item never varies.
    """
    rows, left_out = answered(answers)
    n, k = rows.shape
    if k < 3 or n < 3:
        raise TooFewData(f"{n} subjects and {k} items are too few; 3 of each are needed.")
    covariance = _covariances(rows[np.newaxis])
    variances = covariance[0].diagonal()
    if (variances <= 0.0).any():
        place = int(np.argmin(variances))
        raise ConstantData(f"Item {place + 1} of {k} has the same answer from all {n} subjects.")
    loadings = _loadings(covariance)[0]
    return Omega(
        omega=float(_omega(rows[np.newaxis])[0]),
        interval=bootstrap_interval(
            rows, _omega, rng=rng, confidence=confidence, resamples=resamples
        ),
        loadings=tuple(loadings.tolist()),
        heywood=bool((np.square(loadings) > variances * (1.0 + 1e-9)).any()),
        n=n,
        n_left_out=left_out,
    )


def _covariances(draws: FloatArray) -> FloatArray:
    """(draws, k, k) of (draws, n, k)."""
    about = draws - draws.mean(axis=1, keepdims=True)
    products: FloatArray = np.matmul(about.transpose(0, 2, 1), about)
    products /= draws.shape[1] - 1
    return products


def _omega(draws: FloatArray) -> FloatArray:
    covariances = _covariances(draws)
    loadings = _loadings(covariances)
    variances = np.diagonal(covariances, axis1=1, axis2=2)
    common = np.square(loadings.sum(axis=1))
    errors = np.maximum(variances - np.square(loadings), 0.0).sum(axis=1)
    total = common + errors
    found: FloatArray = np.divide(common, total, out=np.zeros_like(total), where=total > 0.0)
    return found


def _loadings(covariances: FloatArray) -> FloatArray:
    """(draws, k): each loading in turn is the least-squares fit to its row, given the others."""
    off = covariances.copy()
    items = np.arange(off.shape[1])
    off[:, items, items] = 0.0
    loadings = np.sqrt(np.maximum(np.diagonal(covariances, axis1=1, axis2=2), 0.0)) * 0.7
    for _ in range(_ROUNDS):
        for item in items:
            weight = np.square(loadings).sum(axis=1) - np.square(loadings[:, item])
            fitted = np.einsum("di,di->d", off[:, item], loadings)
            loadings[:, item] = np.divide(
                fitted, weight, out=np.zeros_like(fitted), where=weight > 1e-300
            )
    return loadings
