"""Internal consistency of the items of a scale: Cronbach's alpha and McDonald's omega.

alpha = k / (k - 1) (1 - sum_i var_i / var of the sum), of k items. It equals the reliability of the
sum if all items measure the same with the same loading (essentially tau-equivalent) and their
errors are independent; otherwise it is a lower bound. Reverse-worded items must be reversed
beforehand. The interval is Feldt's: (1 - alpha) / (1 - estimate) is F-distributed with n - 1 and (n
- 1)(k - 1) degrees of freedom.

Cronbach 1951, Psychometrika 16:297-334; Feldt, Woodruff and Salih 1987, Appl. Psych. Meas. 11:93.

Omega is the reliability of a sum whose items load differently on one factor. One factor is fitted
to the covariances of the items: s_ij = l_i l_j for i != j, with loadings l by least squares over
the off-diagonal entries (the estimator called minres or ULS). The rest of an item's variance is its
error, e_i = s_ii - l_i^2. Then

    omega = (sum l)^2 / ((sum l)^2 + sum e),

which is omega total of a one-factor model; equal loadings give Cronbach's alpha. No distribution is
assumed. Its interval is a BCa bootstrap over subjects. Omega needs many more subjects than a dozen
to be of use, as the width of the interval shows.

McDonald 1999, Test Theory; Harman and Jones 1966, Psychometrika 31:351-368.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import fdtri

from app.science.statistics.arrays import FloatArray, complete_rows
from app.science.statistics.bootstrap import Interval, bootstrap_interval
from app.science.statistics.errors import ConstantData, StatisticsError, TooFewData


@dataclass(frozen=True)
class Cronbach:
    """Cronbach's alpha of k items answered by n subjects; without unit.

    Attributes:
        alpha: Cronbach's alpha, at most 1; negative if items correlate negatively.
        low, high: ends of Feldt's interval.
        confidence: the confidence level, 0 to 1.
        without_item: alpha of the others, for each item; empty for two items.
        n: subjects with all items; n_left_out: the others (listwise).
    """

    alpha: float
    low: float
    high: float
    confidence: float
    without_item: tuple[float, ...]
    n: int
    n_left_out: int


def cronbach_alpha(answers: npt.ArrayLike, *, confidence: float = 0.95) -> Cronbach:
    """Return Cronbach's alpha of (n subjects, k items); NaN is missing.

    Reverse-worded items must be reversed beforehand.

    Raises TooFewData for fewer than 2 items or complete subjects, ConstantData if the sum is
    constant.
    """
    rows, left_out = complete_answers(answers)
    if not 0.0 < confidence < 1.0:
        raise StatisticsError(f"The confidence is {confidence}; give a number between 0 and 1.")
    n, k = rows.shape
    covariance = np.cov(rows, rowvar=False)
    alpha = _alpha(covariance)
    if not np.isfinite(alpha):
        raise ConstantData(f"The sum of the {k} items is the same for all {n} subjects.")
    tail, df, df_error = 0.5 * (1.0 - confidence), n - 1, (n - 1) * (k - 1)
    others = [np.delete(np.arange(k), item) for item in range(k)] if k > 2 else []
    return Cronbach(
        alpha=alpha,
        low=1.0 - (1.0 - alpha) * float(fdtri(df, df_error, 1.0 - tail)),
        high=1.0 - (1.0 - alpha) * float(fdtri(df, df_error, tail)),
        confidence=confidence,
        without_item=tuple(_alpha(covariance[np.ix_(items, items)]) for items in others),
        n=n,
        n_left_out=left_out,
    )


def complete_answers(answers: npt.ArrayLike) -> tuple[FloatArray, int]:
    """Return complete answers (n, k) and how many subjects are left out; raises TooFewData."""
    table = np.asarray(answers, dtype=np.float64)
    if table.ndim != 2 or table.shape[1] < 2:
        raise TooFewData(f"Answers of shape {table.shape}: at least 2 items are needed.")
    rows, left_out = complete_rows(table)
    if rows.shape[0] < 2:
        raise TooFewData(
            f"{rows.shape[0]} of {table.shape[0]} subjects answered every item; at least 2 are"
            " needed."
        )
    return rows, left_out


def _alpha(covariance: FloatArray) -> float:
    k, total = covariance.shape[0], float(covariance.sum())
    if total <= 1e-12 * float(np.abs(covariance).sum()):
        return float("nan")
    return float(k / (k - 1) * (1.0 - float(np.trace(covariance)) / total))


_ROUNDS = 60


@dataclass(frozen=True)
class Omega:
    """McDonald's omega of k items answered by n subjects.

    Attributes:
        omega: McDonald's omega, 0 to 1.
        interval: the BCa bootstrap interval over subjects.
        loadings: the loading of each item, in the unit of the answers.
        heywood: whether an item's loading explains more than its variance (the model does not fit,
            or there are too few subjects); its error counts as zero.
        n: subjects with all items; n_left_out: the others (listwise).
        estimator: the method by which loadings were estimated.
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
    """Return McDonald's omega of (n subjects, k items); NaN is missing.

    Reverse-worded items must be reversed beforehand.

    Raises TooFewData for fewer than 3 items (the loadings of two cannot be identified) or 3
    complete subjects, ConstantData if an item is constant.
    """
    rows, left_out = complete_answers(answers)
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
    """Return the covariances of the items (draws, k, k) of draws (draws, n, k)."""
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
    """Estimate the loadings (draws, k).

    Each loading in turn is the least-squares fit to its row, given the others.
    """
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
