"""Contrasts between levels on aligned ranks (ART-C), adjusted by Holm's method.

The ranks that test an effect must not be used for pairs of levels of combined factors. ART-C joins
the factors of the contrast into one, aligns for that joint factor, ranks, and compares its levels
by t tests with the residual of the model `ranks ~ factors + (1 | subject)`, pooled over all cells:
(n - 1) (cells - 1) degrees of freedom. For one factor this alignment is that of ART itself; for all
factors together it leaves the values unchanged. Elkin, Kay, Higgins and Wobbrock 2021, UIST,
754-768. Balanced within-subjects designs only; the pooled error assumes equal variances and equal
correlations of all cells. Contested, like the transform itself.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
import numpy.typing as npt
from scipy.special import stdtr

from app.science.statistics.aligned_ranks import CAUTION, aligned_for
from app.science.statistics.arrays import FloatArray
from app.science.statistics.errors import ConstantData, StatisticsError
from app.science.statistics.pairwise import holm
from app.science.statistics.rm_anova import checked_cells


@dataclass(frozen=True)
class AlignedContrast:
    """The difference of level `a` minus level `b` of the contrasted factors, in mean aligned rank.

    Attributes:
        a, b: one level of each contrasted factor.
        estimate: difference of mean ranks; standard_error of it, in ranks.
        t, df, p: two-sided; p_holm adjusted for all pairs.
    """

    a: tuple[str, ...]
    b: tuple[str, ...]
    estimate: float
    standard_error: float
    t: float
    df: int
    p: float
    p_holm: float


@dataclass(frozen=True)
class AlignedContrasts:
    """The contrasts of all pairs of levels; `caution` must be shown with every number."""

    contrasts: tuple[AlignedContrast, ...]
    n: int
    caution: str = CAUTION


def aligned_contrasts(
    values: npt.ArrayLike, levels: Sequence[Sequence[str]], axes: Sequence[int]
) -> AlignedContrasts:
    """Compare all pairs of levels of the factors on `axes`.

    Args:
        values: complete, (n, a) or (n, a, b), all factors within subjects.
        levels: the levels of each factor, in the order of the axes after the first.
        axes: which of these axes are contrasted together: (1,), (2,) or (1, 2).

    Raises ConstantData if there is no residual, StatisticsError for axes or levels that do not
    exist.
    """
    cells = checked_cells(values)
    chosen = _checked_axes(cells, levels, axes)
    ranks = aligned_for(cells, chosen)
    n, size = cells.shape[0], int(np.prod(cells.shape[1:]))
    df = (n - 1) * (size - 1)
    residual = _residual(ranks.reshape(n, size)) / df
    if residual <= 0.0:
        raise ConstantData("The ranks leave no residual to test contrasts against.")
    others = tuple(axis for axis in range(cells.ndim) if axis not in chosen)
    means = ranks.mean(axis=others)
    error = float(np.sqrt(2.0 * residual * means.size / (n * size)))
    names = list(product(*(levels[axis - 1] for axis in chosen)))
    pairs = list(combinations(range(len(names)), 2))
    flat = means.ravel()
    estimates = [float(flat[a] - flat[b]) for a, b in pairs]
    p_values = [2.0 * float(stdtr(df, -abs(difference) / error)) for difference in estimates]
    return AlignedContrasts(
        tuple(
            AlignedContrast(
                names[a], names[b], difference, error, difference / error, df, p, adjusted
            )
            for (a, b), difference, p, adjusted in zip(
                pairs, estimates, p_values, holm(p_values), strict=True
            )
        ),
        n,
    )


def _residual(rows: FloatArray) -> float:
    """Return the sum of squares that neither cells nor subjects explain, for (n, cells) values."""
    about = rows - rows.mean(axis=0) - rows.mean(axis=1, keepdims=True) + rows.mean()
    return float(np.square(about).sum())


def _checked_axes(
    cells: FloatArray, levels: Sequence[Sequence[str]], axes: Sequence[int]
) -> tuple[int, ...]:
    shape = tuple(len(names) for names in levels)
    if shape != cells.shape[1:]:
        raise StatisticsError(f"{shape} levels do not fit values of shape {cells.shape}.")
    chosen = tuple(sorted(set(axes)))
    if not chosen or chosen[0] < 1 or chosen[-1] >= cells.ndim:
        raise StatisticsError(
            f"The axes {tuple(axes)} are not valid; give axes of factors, 1 to {cells.ndim - 1}."
        )
    return chosen
