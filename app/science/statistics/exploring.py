"""Associations of scores with demographics: exploratory, never confirmatory.

A dozen people have a dozen ages, and among many tables one looks striking by chance. So each result
is labelled exploratory, and p is adjusted by Holm's method over everything that was explored.
Numbers are correlated by ranks (Spearman), categories are compared by ranks (Kruskal and Wallis
1952; the effect size epsilon squared = H / (n - 1), 0 to 1).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt
from scipy.special import chdtrc

from app.science.statistics.arrays import midranks
from app.science.statistics.errors import StatisticsError
from app.science.statistics.pairwise import holm
from app.science.statistics.spearman import spearman

LABEL = "exploratory"


@dataclass(frozen=True)
class Explored:
    """The association of one demographic variable with the scores.

    Attributes:
        variable: the name of the variable.
        kind: "number" or "category".
        effect: Spearman's rho, or epsilon squared.
        p, p_holm: two-sided; adjusted for all that was explored together. NaN if there are too few
            data.
        n: subjects with both values; n_left_out: the others.
        why_not: the reason why the association could not be computed; empty if it could.
        label: the label to show with every number.
    """

    variable: str
    kind: Literal["number", "category"]
    effect: float
    p: float
    p_holm: float
    n: int
    n_left_out: int
    why_not: str = ""
    label: str = LABEL


@dataclass(frozen=True)
class _Found:
    kind: Literal["number", "category"]
    effect: float
    p: float
    n: int
    why_not: str = ""


def explore(
    scores: npt.ArrayLike,
    numbers: Mapping[str, npt.ArrayLike] | None = None,
    categories: Mapping[str, Sequence[str | None]] | None = None,
) -> tuple[Explored, ...]:
    """Explore the association of the scores of n subjects with each variable; numbers first.

    Args:
        scores: (n,) scores, NaN where missing.
        numbers: numeric variables by name, (n,) each, NaN where missing.
        categories: categorical variables by name, n words each, None or "" where missing.

    Raises StatisticsError for columns of another length. A variable that cannot be computed is in
    the result with its reason.
    """
    values = np.asarray(scores, dtype=np.float64)
    found: dict[str, _Found] = {}
    for name, column in (numbers or {}).items():
        found[name] = _number(values, np.asarray(column, dtype=np.float64), name)
    for name, words in (categories or {}).items():
        found[name] = _category(values, words, name)
    adjusted = holm([result.p for result in found.values()])
    return tuple(
        Explored(
            name,
            result.kind,
            result.effect,
            result.p,
            p,
            result.n,
            values.size - result.n,
            result.why_not,
        )
        for (name, result), p in zip(found.items(), adjusted, strict=True)
    )


def _number(scores: npt.NDArray[np.float64], column: npt.NDArray[np.float64], name: str) -> _Found:
    _check(scores, column.size, name)
    try:
        found = spearman(column, scores)
    except StatisticsError as error:
        n = int((~(np.isnan(column) | np.isnan(scores))).sum())
        return _Found("number", np.nan, np.nan, n, str(error))
    return _Found("number", found.rho, found.p, found.n)


def _category(scores: npt.NDArray[np.float64], words: Sequence[str | None], name: str) -> _Found:
    _check(scores, len(words), name)
    complete = ~np.isnan(scores) & np.array([bool(word) for word in words], dtype=np.bool_)
    values = scores[complete]
    names, group = np.unique(
        [word or "" for word, use in zip(words, complete, strict=True) if use],
        return_inverse=True,
    )
    n = values.size
    if n < 3 or names.size < 2 or names.size == n or np.ptp(values) <= 0.0:
        why = f"{n} subjects in {names.size} categories cannot be compared"
        return _Found("category", np.nan, np.nan, n, why)
    ranks = midranks(values)
    sizes = np.bincount(group)
    means = np.bincount(group, weights=ranks) / sizes
    middle = 0.5 * (n + 1)
    between = float(sizes @ np.square(means - middle))
    h = (n - 1) * between / float(np.square(ranks - middle).sum())
    return _Found("category", h / (n - 1), float(chdtrc(names.size - 1, h)), n)


def _check(scores: npt.NDArray[np.float64], size: int, name: str) -> None:
    if scores.ndim != 1 or scores.size != size:
        raise StatisticsError(f"{name} has {size} values for scores of shape {scores.shape}.")
