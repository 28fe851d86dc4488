"""Read numbers from delimited text into one array, line by line, within limits."""

import csv
import math
from array import array
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from operator import itemgetter
from typing import Any

import numpy as np
import numpy.typing as npt

from app.adapters.captures.capture import CaptureError, Limits
from app.science.rig import BoolArray
from app.science.rotations import FloatArray

FARTHEST_M = 1e5
"""Largest plausible coordinate; no capture volume is wider than this."""
_MISSING = frozenset({"", "nan", "null", "none", "n/a", "-"})


@dataclass(frozen=True, eq=False)
class NumberTable:
    """The chosen columns of a table.

    Attributes:
        lines: (N,) line of each row in the file, from 1.
        values: (N, C) numbers, NaN for empty cells.
    """

    lines: npt.NDArray[np.int64]
    values: FloatArray


def csv_rows(
    lines: Iterable[str], separator: str = ",", *, quoted: bool = True
) -> Iterator[tuple[int, list[str]]]:
    """Yield (line number, cells) of each row; raise CaptureError if the text is not a table.

    Args:
        lines: all lines of the file.
        separator: the character between cells.
        quoted: whether a quote at the start of a cell opens a quotation, which may span lines.
    """
    reader = csv.reader(
        lines, delimiter=separator, quoting=csv.QUOTE_MINIMAL if quoted else csv.QUOTE_NONE
    )
    while True:
        try:
            row = next(reader)
        except StopIteration:
            return
        except csv.Error as error:
            raise CaptureError(
                f"this is no row of a table: {error}.", line=reader.line_num
            ) from None
        yield reader.line_num, row


def read_titles(rows: Iterator[tuple[int, list[str]]]) -> tuple[int, list[str]]:
    """Return line and column titles of the first row that is not blank."""
    for line, row in rows:
        if any(row):
            return line, [title.strip() for title in row]
    raise CaptureError("the table has no columns.")


def read_numbers(
    rows: Iterable[tuple[int, list[str]]],
    columns: Sequence[tuple[int, str]],
    limits: Limits,
    *,
    decimal: str = ".",
) -> NumberTable:
    """Read the chosen columns, (index, title), of every row that is not blank.

    Raises:
        CaptureError: (with line and column) a row is too short, a cell is neither empty nor a
            finite number, there are no rows, or more numbers than allowed.
    """
    # At least two columns, because itemgetter with one index does not return a tuple.
    pick: Any = itemgetter(*(index for index, _ in columns), columns[0][0])
    width = len(columns)
    values, lines = array("d"), array("q")
    for line, row in rows:
        if not row or not any(row):
            continue
        if len(values) + width > limits.values:
            raise CaptureError(f"more than {limits.values} numbers: split the file.", line=line)
        try:
            cells = pick(row)[:width]
        except IndexError:
            raise _too_short(row, columns, line) from None
        if decimal != ".":
            cells = [cell.replace(decimal, ".") for cell in cells]
        start = len(values)
        try:
            values.extend(map(float, cells))
        except ValueError:
            del values[start:]
            values.extend(
                _number(cell, title, line) for cell, (_, title) in zip(cells, columns, strict=True)
            )
        lines.append(line)
    return _table(values, lines, columns)


def _table(
    values: "array[float]", lines: "array[int]", columns: Sequence[tuple[int, str]]
) -> NumberTable:
    if not lines:
        raise CaptureError("the table has no row of numbers.")
    found = np.frombuffer(values, dtype=np.float64).reshape(len(lines), len(columns))
    table = NumberTable(np.frombuffer(lines, dtype=np.int64), found)
    endless = np.isinf(found)
    if endless.any():
        row, column = (int(index) for index in np.argwhere(endless)[0])
        title = columns[column][1]
        raise CaptureError(f"{title} is infinite: a number or nothing is valid.", line=lines[row])
    return table


def _number(cell: str, title: str, line: int) -> float:
    text = cell.strip()
    if text.lower() in _MISSING:
        return math.nan
    try:
        if "_" in text:  # in Python 8_0 is 80
            raise ValueError
        return float(text)
    except ValueError:
        raise CaptureError(
            f"{title} is {text[:40]!r}: a number or nothing is valid.", line=line
        ) from None


def _too_short(row: list[str], columns: Sequence[tuple[int, str]], line: int) -> CaptureError:
    missing = next(title for index, title in columns if index >= len(row))
    needed = max(index for index, _ in columns) + 1
    return CaptureError(
        f"{len(row)} cells in this row, {needed} are needed: {missing} is missing.", line=line
    )


def check_places(places_m: FloatArray, lines: npt.NDArray[np.int64], names: Sequence[str]) -> None:
    """Raise CaptureError if positions (N, B, 3) are too far away for any room; NaN is allowed."""
    far = np.abs(places_m) > FARTHEST_M
    if far.any():
        row, body, axis = (int(index) for index in np.argwhere(far)[0])
        raise CaptureError(
            f"{names[body]} is at {places_m[row, body, axis]:g} m, up to {FARTHEST_M:g} m is"
            " plausible: check the unit.",
            line=int(lines[row]),
        )


def unit_rotations(
    q: FloatArray, lines: npt.NDArray[np.int64], names: Sequence[str], tolerance: float = 0.02
) -> FloatArray:
    """Return quaternions (N, B, 4) scaled to exactly unit length; NaN, or all zero, becomes NaN.

    Raises:
        CaptureError: a length differs from 1 by more than rounding explains.
    """
    unseen = np.isnan(q).any(axis=-1) | (q == 0.0).all(axis=-1)
    length = np.linalg.norm(np.clip(q, -1e6, 1e6), axis=-1)
    wrong = ~unseen & (np.abs(length - 1.0) > tolerance)
    if wrong.any():
        row, body = (int(index) for index in np.argwhere(wrong)[0])
        raise CaptureError(
            f"the quaternion of {names[body]} has length {length[row, body]:.4g}: 1 is valid.",
            line=int(lines[row]),
        )
    scaled: FloatArray = q / np.where(unseen, np.nan, length)[..., np.newaxis]
    return scaled


def unseen(*values: FloatArray) -> BoolArray:
    """Return where any number of a body is missing in any of the arrays (..., C), shape (...)."""
    missing = [np.isnan(array).any(axis=-1) for array in values]
    return np.asarray(np.logical_or.reduce(missing), dtype=np.bool_)
