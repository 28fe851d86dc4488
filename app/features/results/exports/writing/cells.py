"""Write CSV cells: numbers with full precision, texts protected from running as formulas.

A spreadsheet runs a text cell that begins with = + - @ as a formula, also after white space or a
quotation mark. An apostrophe in front makes it text (OWASP, CSV injection). Only texts are changed:
numbers, including negative ones, stay numbers.
"""

import csv
import io
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import pandas as pd

from app.features.results.analysis.codebook import ColumnType, columns_of

ROWS_PER_PIECE = 2000
# Some spreadsheets treat the full-width forms like the ASCII ones.
_RUNS = re.compile("^(?:[\\t\\r\\n]|[\\s\"'\ufeff\u200b]*[=+\\-@\uff1d\uff0b\uff0d\uff20])")


def safe_text(text: str) -> str:
    """Return the text, with an apostrophe in front if a spreadsheet would run it as a formula."""
    return f"'{text}" if _RUNS.match(text) else text


def csv_pieces(table: str, frame: pd.DataFrame, *, rules: bool = True) -> Iterator[bytes]:
    """Yield a table as CSV in pieces: UTF-8, LF, quoted as in RFC 4180, missing values empty.

    `rules`: include the columns that exist only for studies with `valid_when` rules.
    """
    yield from csv_pieces_of_many(table, [frame], rules=rules)


def csv_pieces_of_many(
    table: str, frames: Iterable[pd.DataFrame], *, rules: bool = True
) -> Iterator[bytes]:
    """Yield a table that comes in several frames as one CSV, as `csv_pieces` does of one."""
    columns = columns_of(table, rules=rules)
    yield _lines([[column.name for column in columns]])
    for frame in frames:
        for first in range(0, len(frame), ROWS_PER_PIECE):
            part = frame.iloc[first : first + ROWS_PER_PIECE]
            cells = [_cells(part[column.name].tolist(), column.type) for column in columns]
            yield _lines(list(zip(*cells, strict=True)))


def plain_pieces(names: Sequence[str], rows: Iterator[Sequence[Any]]) -> Iterator[bytes]:
    """Yield a table whose columns depend on the study, in the same way.

    Texts and booleans are recognised by their values; everything else is a number.
    """
    yield _lines([list(names)])
    for row in rows:
        yield _lines([[_plain(value) for value in row]])


def _plain(value: Any) -> str:
    if pd.isna(value):
        return ""
    kind: ColumnType = (
        "text" if isinstance(value, str) else "boolean" if isinstance(value, bool) else "number"
    )
    return _WRITERS[kind](value)


def _cells(values: Sequence[Any], kind: ColumnType) -> list[str]:
    write = _WRITERS[kind]
    return ["" if pd.isna(value) else write(value) for value in values]


def _time(value: pd.Timestamp) -> str:
    return value.isoformat(timespec="microseconds").replace("+00:00", "Z")


_WRITERS: dict[ColumnType, Callable[[Any], str]] = {
    "text": lambda value: safe_text(str(value)),
    "integer": str,
    "number": lambda value: repr(float(value)),
    "boolean": lambda value: "true" if value else "false",
    "time": _time,
}


def _lines(rows: Sequence[Sequence[str]]) -> bytes:
    if any("\r" in cell for row in rows for cell in row):
        return b"".join(_line_with_returns(row) for row in rows)
    buffer = io.StringIO(newline="")
    csv.writer(buffer, lineterminator="\n").writerows(rows)
    return buffer.getvalue().encode()


def _line_with_returns(row: Sequence[str]) -> bytes:
    """Return a line with carriage returns quoted, as readers need.

    Python up to 3.12 quotes a carriage return only if lines end with one.
    """
    buffer = io.StringIO(newline="")
    csv.writer(buffer, lineterminator="\r\n").writerow(row)
    return buffer.getvalue().removesuffix("\r\n").encode() + b"\n"
