"""Analysis of variance with repeated measures: one or more factors, all within subjects.

Each effect is tested against its own interaction with subjects. Assumes interval values, subjects
independent of each other, approximately normal contrast scores, and for p (not for p_gg)
sphericity: all differences between levels have equal variance. Greenhouse and Geisser's epsilon
corrects for a violation; report p_gg. For an interaction epsilon is computed from its own contrasts
(the Kronecker product of those of its factors), as in jamovi, SPSS and pingouin.

Winer, Brown and Michels 1991, Statistical Principles in Experimental Design, chapters 4 and 7.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import combinations

import numpy as np
import numpy.typing as npt

from app.science.statistics.arrays import FloatArray
from app.science.statistics.effects import Effect, Part, contrasts, tested_effect
from app.science.statistics.errors import StatisticsError, TooFewData


@dataclass(frozen=True)
class RmAnova:
    """The effects of an analysis: main effects, then interactions; n subjects, all complete."""

    effects: tuple[Effect, ...]
    n: int


def rm_anova(values: npt.ArrayLike, factors: Sequence[str] = ("A", "B", "C")) -> RmAnova:
    """Test complete values of shape (n, a) or (n, a, b): subjects first, then one axis per factor.

    Args:
        values: the values in the unit of the measure; subjects with a missing value must be left
            out beforehand.
        factors: names of the axes after the first; surplus names are ignored.

    Raises ConstantData if an effect has no error (all subjects differ equally between levels),
    TooFewData for fewer than 2 subjects or levels, StatisticsError for missing values.
    """
    cells = checked_cells(values)
    names = tuple(factors)[: cells.ndim - 1]
    if len(names) < cells.ndim - 1:
        raise StatisticsError(f"{cells.ndim - 1} factors need as many names; {len(names)} given.")
    n, shape = cells.shape[0], cells.shape[1:]
    rows = cells.reshape(n, -1)
    subjects = rows.mean(axis=1)
    spread = rows.shape[1] * float(np.square(subjects - subjects.mean()).sum())
    parts = [
        _part(rows, shape, chosen, ":".join(names[place] for place in chosen))
        for size in range(1, len(shape) + 1)
        for chosen in combinations(range(len(shape)), size)
    ]
    spread += sum(part.ss_error for part in parts)
    return RmAnova(tuple(tested_effect(part, spread) for part in parts), n)


def checked_cells(values: npt.ArrayLike) -> FloatArray:
    """Return (n, a, ...) values after checking that all are finite and no axis is shorter than 2.

    Raises the same errors as `rm_anova`.
    """
    cells = np.asarray(values, dtype=np.float64)
    if cells.ndim < 2:
        raise StatisticsError(
            f"Shape {cells.shape}: give subjects first, then one axis per factor."
        )
    if min(cells.shape) < 2:
        raise TooFewData(
            f"Shape {cells.shape}: at least 2 complete subjects and 2 levels of each factor are"
            " needed."
        )
    if not np.isfinite(cells).all():
        raise StatisticsError(
            "A value is missing or infinite. Leave its subject out by a stated rule first."
        )
    return cells


def effect_columns(shape: tuple[int, ...], chosen: tuple[int, ...]) -> FloatArray:
    """Return orthonormal contrasts (cells, d) of the effect of the chosen axes."""
    columns = [
        contrasts(size) if place in chosen else np.full((size, 1), size**-0.5)
        for place, size in enumerate(shape)
    ]
    return reduce(np.kron, columns)


def _part(rows: FloatArray, shape: tuple[int, ...], chosen: tuple[int, ...], name: str) -> Part:
    n = rows.shape[0]
    scores = rows @ effect_columns(shape, chosen)
    mean = scores.mean(axis=0)
    about = scores - mean
    scatter = about.T @ about
    d = scores.shape[1]
    return Part(
        name=name,
        ss=n * float(mean @ mean),
        ss_error=float(np.trace(scatter)),
        df=d,
        df_error=d * (n - 1),
        covariance=scatter / (n - 1),
    )
