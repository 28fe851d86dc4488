"""Convert a tidy table to cells: one value for every subject and combination of levels.

A tidy table has one row per observation: who (subject), under which conditions (a level of each
within-subjects factor), how much (the measure). Each row belongs to one cell.

The rules for missing and duplicate values; each is reported in the result:

    several rows in one cell    are averaged, and counted (`n_averaged`)
    rows without a value        do not count in that mean, and are counted (`n_empty`)
    a cell without a value      is NaN
    Friedman, Page, ANOVA, ART  use subjects with every cell only (listwise): `complete` names
                                those it leaves out
    signed-rank tests           use each complete pair of levels of a subject (pairwise), and count
                                what is left out of each

Nothing is imputed.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from app.science.statistics.arrays import FloatArray, IntArray
from app.science.statistics.errors import StatisticsError, TooFewData, UnusableTable
from app.science.statistics.levels import (
    as_number,
    declared_levels,
    level_places,
    ordered_levels,
)

MISSING = frozenset({"", "na", "n/a", "nan", "null", "none", "."})
"""Texts that mean a missing value, in upper or lower case."""
_AVERAGE_DIGITS = 14
_LARGEST = 1e150
"""Larger numbers have squares, and so variances, that are no numbers any more."""


@dataclass(frozen=True, eq=False)
class Complete:
    """The values of the subjects that have every cell.

    Attributes:
        values: (n, a) or (n, a, b) values without NaN.
        subjects: n names, in the order of rows.
        left_out: names of those with a missing cell.
    """

    values: FloatArray
    subjects: tuple[str, ...]
    left_out: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Cells:
    """A table by cells, in the unit of the measure.

    Attributes:
        subjects: n names, as they first appear.
        factors: one name for each axis after the first.
        levels: the levels of each factor, in order (see `levels.py`).
        values: (n, a) or (n, a, b) mean of each cell; NaN where nothing was measured.
        rows: same shape, the number of values in each mean.
        n_empty: number of rows without a value.
    """

    subjects: tuple[str, ...]
    factors: tuple[str, ...]
    levels: tuple[tuple[str, ...], ...]
    values: FloatArray
    rows: IntArray
    n_empty: int

    @property
    def n_averaged(self) -> int:
        """The number of cells that are the mean of several rows."""
        return int((self.rows > 1).sum())

    @property
    def n_missing(self) -> int:
        """The number of cells without a value."""
        return int((self.rows == 0).sum())

    def complete(self) -> Complete:
        """Leave out every subject with a missing cell (listwise); possibly none is left."""
        complete = (self.rows > 0).reshape(len(self.subjects), -1).all(axis=1)
        names = np.array(self.subjects, dtype=object)
        return Complete(self.values[complete], tuple(names[complete]), tuple(names[~complete]))

    def of_factor(self, axis: int) -> FloatArray:
        """Return the values by the factor on `axis` (from 1), averaged over the other factors.

        The result is (n, levels); a subject's mean is NaN if one of its cells is missing.
        """
        others = tuple(other for other in range(1, self.values.ndim) if other != axis)
        return _rounded(self.values.mean(axis=others)) if others else self.values


def cells_of(
    subjects: Sequence[str],
    within: Mapping[str, Sequence[str]],
    measure: Sequence[str | float],
    *,
    measure_name: str = "measure",
    subject_name: str = "subject",
    lines: Sequence[int] | None = None,
    orders: Mapping[str, Sequence[str]] | None = None,
) -> Cells:
    """Sort the rows of a tidy table into cells.

    Args:
        subjects: one name per row.
        within: each within-subjects factor's name, with one level per row.
        measure: one value per row, as number or text; NaN or one of MISSING where missing.
        measure_name, subject_name: names of the two columns, for messages.
        lines: the line of each row in its file, for messages; by default rows count from 1.
        orders: the declared order of a factor's levels; without one see `levels.py`.

    Raises:
        UnusableTable: a subject or level is empty, or a value is not a finite number; names line,
            column and value.
        TooFewData: no row, fewer than two subjects, or a factor with one level.
        StatisticsError: columns of different length, no factor, an order that does not list the
            levels of its factor.
    """
    _check_lengths(subjects, within, measure)
    where = list(lines) if lines is not None else list(range(1, len(subjects) + 1))
    names = [_named(text, subject_name, line) for text, line in zip(subjects, where, strict=True)]
    level_columns = {
        factor: [_named(text, factor, line) for text, line in zip(column, where, strict=True)]
        for factor, column in within.items()
    }
    values = [
        _number(value, measure_name, line) for value, line in zip(measure, where, strict=True)
    ]
    declared = {} if orders is None else orders
    levels = tuple(
        declared_levels(factor, column, declared[factor])
        if factor in declared
        else ordered_levels(column)
        for factor, column in level_columns.items()
    )
    who = tuple(dict.fromkeys(names))
    _check_numbers(who, tuple(within), levels)
    sums, rows = _sums_by_cell(who, names, levels, list(level_columns.values()), values)
    with np.errstate(invalid="ignore", divide="ignore"):
        means = _rounded(sums / rows)
    empty = sum(math.isnan(value) for value in values)
    return Cells(who, tuple(within), levels, means, rows, empty)


def _sums_by_cell(
    who: tuple[str, ...],
    names: list[str],
    levels: tuple[tuple[str, ...], ...],
    columns: list[list[str]],
    values: list[float],
) -> tuple[FloatArray, IntArray]:
    """Return the sum and the number of the values in each cell."""
    shape = (len(who), *(len(factor_levels) for factor_levels in levels))
    subject_place = {name: place for place, name in enumerate(who)}
    index = [np.array([subject_place[name] for name in names])]
    for factor_levels, column in zip(levels, columns, strict=True):
        places = level_places(factor_levels)
        index.append(
            np.array([places.get(level, places.get(as_number(level), -1)) for level in column])
        )
    flat = np.ravel_multi_index(tuple(index), shape)
    numbers = np.array(values)
    there = ~np.isnan(numbers)
    size = math.prod(shape)
    sums = np.bincount(flat[there], weights=numbers[there], minlength=size).astype(np.float64)
    rows = np.bincount(flat[there], minlength=size).astype(np.int64)
    return sums.reshape(shape), rows.reshape(shape)


def _rounded(means: FloatArray) -> FloatArray:
    """Round means to 14 digits, so that 0.1 + 0.2 + 0.3 and 3 x 0.2 are tied."""
    size = np.abs(means)
    digits = np.floor(np.log10(np.where(size > 0.0, size, 1.0)))
    unit = 10.0 ** (_AVERAGE_DIGITS - 1 - digits)
    even: FloatArray = np.where(np.isfinite(unit), np.round(means * unit) / unit, means)
    return even


def _check_lengths(
    subjects: Sequence[str], within: Mapping[str, Sequence[str]], measure: Sequence[object]
) -> None:
    if not within:
        raise StatisticsError("No within-subject factor was named; name at least one.")
    lengths = {len(subjects), len(measure), *(len(column) for column in within.values())}
    if len(lengths) != 1:
        raise StatisticsError(f"The columns have {sorted(lengths)} rows; give all the same number.")
    if not subjects:
        raise TooFewData("The table has no row; give one row for each observation.")


def _check_numbers(
    who: tuple[str, ...], factors: tuple[str, ...], levels: tuple[tuple[str, ...], ...]
) -> None:
    if len(who) < 2:
        raise TooFewData(
            f"There is only one subject, {who[0]!r}; at least two are needed for any test."
        )
    for factor, found in zip(factors, levels, strict=True):
        if len(found) < 2:
            raise TooFewData(
                f"Column {factor!r} has only one level, {found[0]!r}; at least two are"
                " needed for a comparison."
            )


def _named(text: str, column: str, line: int) -> str:
    name = text.strip()
    if name.casefold() in MISSING - {"none"}:
        raise UnusableTable(
            f"Line {line}, column {column!r}: {text!r} is not a name. Give every row one."
        )
    return name


def _number(value: str | float, column: str, line: int) -> float:
    if isinstance(value, str):
        text = value.strip()
        if text.casefold() in MISSING:
            return math.nan
        number = as_number(text)
        if number is None:
            raise UnusableTable(
                f"Line {line}, column {column!r}: {value!r} is not a finite number. Write numbers"
                " with a point (in a table with semicolons, a comma will do), without a sign"
                " between thousands, and leave the cell empty (or NA) where a value is missing."
            )
        return _squared(number, column, line)
    number = float(value)
    if math.isinf(number):
        raise UnusableTable(f"Line {line}, column {column!r}: {value!r} is infinite.")
    return _squared(number, column, line)


def _squared(number: float, column: str, line: int) -> float:
    """Return a number whose square is one, too; raise UnusableTable for a larger one."""
    if abs(number) > _LARGEST:
        raise UnusableTable(
            f"Line {line}, column {column!r}: {number:g} is beyond {_LARGEST:g}, and its variance"
            " would be no number. Give the measure in another unit."
        )
    return number
