"""Parse a file of answers as a table: find the separator and the header rows, number the lines.

Survey tools write more than one header row: names, then the questions, then ids of their own. The
ids are recognised by their format; otherwise one header row is assumed unless a person says more.
"""

import csv
import io
import re
from collections import Counter
from dataclasses import dataclass

from app.errors import InvalidInput

SEPARATORS = (",", ";", "\t")
MAX_ROWS, MAX_COLUMNS, MAX_CELL = 20_000, 1000, 5000
INSPECTED_CHARACTERS = 10_000
_CONTROL = re.compile("[\x00-\x08\x0e-\x1f]")
_OTHER_KINDS = {
    "\x89PNG": "a picture",
    "\u2030PNG": "a picture",
    "\xff\xd8": "a picture",
    "GIF8": "a picture",
    "%PDF-": "a PDF",
    "PK\x03\x04": "a workbook or an archive",
}
"""Kinds of files that are not tables, by their first characters as Latin-1 or Windows-1252."""
_TOOL_IDS = ('{"importid"', "{'importid'")


@dataclass(frozen=True)
class SheetRow:
    """A row, with the line of the file on which it ends, counted from 1."""

    line: int
    cells: list[str]


@dataclass(frozen=True)
class Sheet:
    """A parsed file: named columns, the question below each name, and the rows."""

    separator: str
    header_rows: int
    header: list[str]
    labels: list[str]
    rows: list[SheetRow]

    def column(self, name: str) -> int:
        """Return the index of a column; raise InvalidInput if there is none of this name."""
        if name not in self.header:
            raise InvalidInput(
                f"the file has no column {name!r}",
                value=name,
                valid=self.header,
                remedy="Choose one of its columns; the file may have changed since it was mapped.",
            )
        return self.header.index(name)

    def values(self, name: str) -> list[str]:
        """Return the values of a column, row by row."""
        at = self.column(name)
        return [row.cells[at].strip() for row in self.rows]


def read_sheet(text: str, header_rows: int | None = None) -> Sheet:
    """Parse a file; raise InvalidInput with the line that cannot be read."""
    text = text.removeprefix("\ufeff")
    _require_table(text)
    separator = _separator(text)
    rows = _rows(text, separator)
    if not rows:
        raise InvalidInput("the file is empty", remedy="Save the table as CSV UTF-8 with a header.")
    header_count = header_rows or _header_rows(rows)
    header = [cell.strip() for cell in rows[0].cells]
    _check_shape(rows, header, header_count)
    labels = [cell.strip() for cell in rows[1].cells] if header_count > 1 else [""] * len(header)
    return Sheet(separator, header_count, header, labels, rows[header_count:])


def _separator(text: str) -> str:
    first = next((line for line in io.StringIO(text) if line.strip()), "")
    return max(SEPARATORS, key=first.count)


def _require_table(text: str) -> None:
    """Raise InvalidInput if the file is not text: a picture, a PDF or an Excel workbook."""
    kind = next((kind for begins, kind in _OTHER_KINDS.items() if text.startswith(begins)), None)
    if kind is None and _CONTROL.search(text[:INSPECTED_CHARACTERS]) is None:
        return
    raise InvalidInput(
        f"this is {kind}, not a table" if kind else "this is not a text file",
        valid="a table as CSV or TSV, with the names of its columns in the first row",
        remedy="Open it in the program it came from and save it as CSV UTF-8.",
    )


def _rows(text: str, separator: str) -> list[SheetRow]:
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    rows: list[SheetRow] = []
    try:
        for cells in reader:
            if any(cell.strip() for cell in cells):
                rows.append(SheetRow(reader.line_num, cells))
            if len(rows) > MAX_ROWS:
                raise _too_long()
    except csv.Error as error:
        raise InvalidInput(
            f"line {reader.line_num} cannot be read: a quote is in the wrong place or never closed",
            value=reader.line_num,
            remedy="Close every quote; write a quote inside a quoted cell twice.",
        ) from error
    return rows


def _too_long() -> InvalidInput:
    return InvalidInput(
        "the file has too many rows", valid=f"at most {MAX_ROWS}", remedy="Split it."
    )


def _header_rows(rows: list[SheetRow]) -> int:
    for at in (1, 2):
        if at < len(rows):
            cells = [cell.strip().lower() for cell in rows[at].cells if cell.strip()]
            if cells and sum(cell.startswith(_TOOL_IDS) for cell in cells) * 2 > len(cells):
                return at + 1
    return 1


def _check_shape(rows: list[SheetRow], header: list[str], header_count: int) -> None:
    if len(header) > MAX_COLUMNS:
        raise InvalidInput("the file has too many columns", valid=f"at most {MAX_COLUMNS}")
    duplicates = [name for name, count in Counter(header).items() if count > 1 or not name]
    if duplicates:
        raise InvalidInput(
            f"the column name {duplicates[0]!r} is there more than once"
            if duplicates[0]
            else "a column has no name",
            value=duplicates[0],
            remedy="Give every column a name of its own in the first row.",
        )
    for row in rows[header_count:]:
        if len(row.cells) != len(header):
            raise InvalidInput(
                f"line {row.line} has {len(row.cells)} cells, but the header has {len(header)}",
                value=row.line,
                valid=len(header),
                remedy="Give every row one cell for each column, and put text that contains "
                "separators in quotes.",
            )
        if any(len(cell) > MAX_CELL or "\0" in cell for cell in row.cells):
            raise InvalidInput(
                f"line {row.line} has a cell that is too long or not text",
                value=row.line,
                valid=f"text of at most {MAX_CELL} characters",
            )
    if len(rows) <= header_count:
        raise InvalidInput("the file has a header but no rows", valid="at least one row of answers")
