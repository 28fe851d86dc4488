"""Answers as CSV in, scores as CSV out, for people who keep their data in spreadsheets.

Spreadsheets write the same table in many ways: with ; or tabs, with a byte order mark, with CRLF,
blank lines and Q1 for q1. All of that is read. What cannot be understood is refused with its line.
"""

import csv
import io
from dataclasses import dataclass

import pandas as pd

from app.science.instruments.columns import item_name
from app.science.instruments.errors import AnswerError, InstrumentTableError, shortened
from app.science.instruments.model import Instrument
from app.science.instruments.tables import score_table

_SEPARATORS = (",", ";", "\t")


@dataclass(frozen=True)
class _Row:
    """The cells of one row, and the line of the file on which it ends (from 1)."""

    line: int
    cells: list[str]


def score_csv(instrument: Instrument, text_in: str) -> str:
    """Score a CSV of raw answers: id columns as they are, then one column for each score.

    `text_in`: a header line, then one row for each filled-in form; columns named like items hold
    answers, empty (or NA) where missing. The result uses commas and \\n; scores have every digit
    that a float has and are empty where they have no value. A header alone gives a header.

    Raises InstrumentTableError, naming line and column, for: no header, no item column, doubled
    columns, a row of another length, broken quotes, an answer off its scale.
    """
    separator, header, rows = _read(instrument, text_in.removeprefix("\ufeff"))
    for row in rows:
        if len(row.cells) != len(header):
            raise InstrumentTableError(
                f"Line {row.line} has {len(row.cells)} cells, but the header has {len(header)}. "
                "Give every row one cell for each column, and put text with separators in quotes."
            )
    cells = [row.cells for row in rows]
    if separator == ";":
        # Where ; separates cells, spreadsheets write decimals with a comma.
        cells = [_with_points(instrument, header, row) for row in cells]
    frame = pd.DataFrame(cells, columns=header, dtype=object)
    try:
        table = score_table(instrument, frame)
    except AnswerError as error:
        raise _located(error, instrument, header, rows) from error
    return _written(table, [score.key for score in instrument.scores])


def _read(instrument: Instrument, text: str) -> tuple[str, list[str], list[_Row]]:
    lines = io.StringIO(text, newline="")
    first = next((line for line in lines if line.strip()), "")
    if not first:
        raise _empty(instrument)

    def n_items(separator: str) -> int:
        names = (cell.strip().strip('"') for cell in first.strip("\r\n").split(separator))
        return sum(item_name(instrument, name) in instrument.by_key for name in names)

    separator = max(_SEPARATORS, key=n_items)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    rows: list[_Row] = []
    try:
        rows.extend(
            _Row(reader.line_num, cells)
            for cells in reader
            if len(cells) > 1 or "".join(cells).strip()
        )
    except csv.Error as error:
        raise InstrumentTableError(
            f"Line {reader.line_num} cannot be read: {error}. "
            'Close every quote; write a quote inside a quoted cell twice ("").'
        ) from error
    if not rows:  # a quoted empty cell is a line of text, but no row
        raise _empty(instrument)
    return separator, rows[0].cells, rows[1:]


def _empty(instrument: Instrument) -> InstrumentTableError:
    return InstrumentTableError(
        "The table is empty. Give a header line with id columns and the items "
        + ", ".join(instrument.by_key)
        + "."
    )


def _with_points(instrument: Instrument, header: list[str], cells: list[str]) -> list[str]:
    return [
        cell.replace(",", ".") if item_name(instrument, name) in instrument.by_key else cell
        for name, cell in zip(header, cells, strict=True)
    ]


def _located(
    error: AnswerError, instrument: Instrument, header: list[str], rows: list[_Row]
) -> InstrumentTableError:
    number = error.row or 1
    row = rows[number - 1]
    at = next(n for n, name in enumerate(header) if item_name(instrument, name) == error.item)
    return InstrumentTableError(
        f"Row {number} (line {row.line}), column {header[at].strip()}: the answer is "
        f"{shortened(row.cells[at])!r}. Valid is {error.valid}, or an empty cell if it is missing. "
        "Correct it and score again; nothing was written."
    )


def _written(table: pd.DataFrame, scores: list[str]) -> str:
    out = io.StringIO(newline="")
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(table.columns.tolist())
    for row in table.itertuples(index=False, name=None):
        ids, values = row[: -len(scores) or None], row[len(row) - len(scores) :]
        writer.writerow([*ids, *("" if value != value else repr(float(value)) for value in values)])
    return out.getvalue()
