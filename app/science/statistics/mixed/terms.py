"""The terms of a model: factors, covariates, and the errors of combining them.

A *factor* names a level for each observation (latency 0, 125 or 350 ms; hand or foot; the block of
the session; the order of conditions). A *covariate* is one or more numbers for each observation
that form one term (days awake; the condition of the previous block, as contrasts).

An observation is one row: all arrays given to a model have the same length N and the same order.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.science.statistics.arrays import FloatArray, IntArray
from app.science.statistics.errors import StatisticsError

#: A value that can be a level: displayed as text, sorted in its own type's order.
Label = str | int | float
_FEWEST_LEVELS = 2


class ModelError(StatisticsError):
    """A model cannot be built or estimated from these observations."""


@dataclass(frozen=True, eq=False)
class Factor:
    """A categorical predictor.

    Attributes:
        name: its name in terms and results.
        levels: the first is the reference with which the others are compared.
        codes: (N,) index into `levels`.
    """

    name: str
    levels: tuple[str, ...]
    codes: IntArray


@dataclass(frozen=True, eq=False)
class Covariate:
    """A numerical predictor of one or more columns, tested as one term.

    Attributes:
        name: its name in terms and results.
        columns: (N, k) values in the covariate's own units.
        parts: k names; one empty name for a single column.
        held_at: (k,) values at which marginal means hold it constant.
    """

    name: str
    columns: FloatArray
    parts: tuple[str, ...]
    held_at: tuple[float, ...]


def factor(name: str, values: Sequence[Label], levels: Sequence[Label] | None = None) -> Factor:
    """Return a factor of observed values.

    Args:
        name: the name of the factor.
        values: N observed levels; none may be missing.
        levels: all levels in order, the reference first; by default those observed, sorted.

    Raises:
        ModelError: there are fewer than two levels, or a value is not among them.
    """
    given = list(values)
    order = sorted(set(given)) if levels is None else list(levels)
    place = {level: at for at, level in enumerate(order)}
    unknown = sorted({str(value) for value in given if value not in place})
    if unknown:
        raise ModelError(
            f"{name} has the levels {_listed(order)}, but the values include {', '.join(unknown)}."
        )
    used = {place[value] for value in given}
    if len(used) < _FEWEST_LEVELS or len(used) < len(order):
        raise ModelError(
            f"{name} needs at least two levels and observations of each; of {_listed(order)} there "
            f"are observations of {_listed([order[at] for at in sorted(used)])}."
        )
    codes = np.array([place[value] for value in given], dtype=np.int64)
    return Factor(name, tuple(str(level) for level in order), codes)


def covariate(name: str, values: Sequence[float] | FloatArray) -> Covariate:
    """Return a covariate of one column, which marginal means hold at its mean.

    Raises:
        ModelError: a value is not finite, or all are the same.
    """
    column = np.asarray(values, dtype=np.float64)
    if not np.isfinite(column).all() or np.ptp(column) == 0.0:
        raise ModelError(f"{name} needs finite values that differ from each other.")
    return Covariate(name, column[:, np.newaxis], ("",), (float(column.mean()),))


def participant_codes(participants: Sequence[Label]) -> IntArray:
    """Return a number from 0 for the participant of each observation, (N,)."""
    place = {name: at for at, name in enumerate(dict.fromkeys(participants))}
    return np.array([place[name] for name in participants], dtype=np.int64)


def _listed(levels: Sequence[Label]) -> str:
    return ", ".join(str(level) for level in levels) or "none"
