"""Cronbach's alpha: how far do the items of a scale go together?

alpha = k / (k - 1) (1 - sum_i var_i / var of the sum), of k items. It equals the reliability of the
sum if all items measure the same with the same loading (essentially tau-equivalent) and their
errors are independent; otherwise it is a lower bound. Items that are worded the other way round
must be reversed before. The interval is Feldt's: (1 - alpha) / (1 - estimate) is F-distributed with
n - 1 and (n - 1)(k - 1) degrees of freedom.

Cronbach 1951, Psychometrika 16:297-334; Feldt, Woodruff and Salih 1987, Appl. Psych. Meas. 11:93.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import fdtri

from app.science.statistics.arrays import FloatArray, complete_rows
from app.science.statistics.errors import ConstantData, StatisticsError, TooFewData


@dataclass(frozen=True)
class Cronbach:
    """Alpha of k items answered by n subjects; without unit.

    Attributes:
        alpha: at most 1; negative where items work against each other.
        low, high: ends of Feldt's interval.
        confidence: 0 to 1.
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
    """Return alpha of (n subjects, k items), reversed items turned round already; NaN is missing.

    Raises TooFewData for fewer than 2 items or complete subjects, ConstantData if the sum never
    varies.
    """
    rows, left_out = answered(answers)
    if not 0.0 < confidence < 1.0:
        raise StatisticsError(f"Confidence {confidence}; give a share between 0 and 1.")
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
        without_item=tuple(_alpha(covariance[np.ix_(kept, kept)]) for kept in others),
        n=n,
        n_left_out=left_out,
    )


def answered(answers: npt.ArrayLike) -> tuple[FloatArray, int]:
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
