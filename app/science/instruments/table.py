"""Score tables of answers, CSV to CSV, for people who keep their data in spreadsheets.

Spreadsheets write the same table in many ways: with ; or tabs, with a byte order mark, with CRLF,
blank lines and Q1 for q1. All of these are accepted. Errors name the line of the file.

This is separate from `scoring` because it needs pandas, which a server that scores single forms
does not have to load.
"""

import csv
import io
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from app.science.instruments.answers import as_number
from app.science.instruments.doubts import reversal_doubts, reversed_items, scale_doubts
from app.science.instruments.errors import AnswerError, InstrumentTableError, shortened
from app.science.instruments.formula import names_in
from app.science.instruments.instrument import Instrument
from app.science.instruments.items import Item
from app.science.instruments.scoring import FloatArray, scores_of_columns

__all__ = ["Scored", "score_csv", "score_table", "scored_csv"]
_NAMED_ROWS = 5
_NAMED_PROBLEMS = 50
_NAMES_OF_PEOPLE = frozenset(
    {"id", "pid", "ppid", "vp", "person", "participant", "participant_id", "subject", "subject_id"}
    | {"code", "respondent", "teilnehmer", "proband"}
)
_SEPARATORS = (",", ";", "\t")
_MISSING = frozenset({"", "na", "n/a", "nan", "null", "none"})
_YES_NO = {"true": True, "yes": True, "false": False, "no": False}


@dataclass(frozen=True)
class _Row:
    """The cells of one row, and the line of the file on which it ends (from 1)."""

    line: int
    cells: list[str]


@dataclass(frozen=True)
class Scored:
    """A scored table as CSV, with sentences on what is to be looked at.

    They name scores without a value (how many, where, why), rows and ids that occur twice, and
    answers that hardly fit the instrument as a whole (`doubts`).
    """

    text: str
    notes: tuple[str, ...]


def score_csv(instrument: Instrument, text_in: str) -> str:
    """Return the `text` of `scored_csv`."""
    return scored_csv(instrument, text_in).text


def scored_csv(instrument: Instrument, text_in: str, missing: Collection[str] = ()) -> Scored:
    r"""Score a CSV of raw answers: id columns unchanged, then one column for each score.

    `text_in`: a header line, then one row for each completed form; columns named like items contain
    answers, empty (or NA, or one of the codes in `missing`) where missing. The result uses commas
    and \n; scores have every digit of a float and are empty where they have no value. A table with
    only a header gives only a header.

    Raises InstrumentTableError, naming line and column, for: no header, no item column, duplicate
    columns, broken quotes; for all rows of another length and all invalid answers together.
    """
    separator, header, rows = _read(instrument, text_in.removeprefix("\ufeff"))
    rows = _without_codes(instrument, header, rows, missing)
    _check_rows(instrument, separator, header, rows)
    cells = [_read_cells(instrument, separator, header, row) for row in rows]
    table = score_table(instrument, pd.DataFrame(cells, columns=header, dtype=object))
    notes = _notes_on_empty_scores(instrument, header, rows, table)
    if len(_item_columns(instrument, header)) < len(header):
        notes += _notes_on_repeated_rows(rows) + _notes_on_repeated_ids(instrument, header, rows)
    notes += _notes_on_answers(instrument, header, cells)
    return Scored(_to_csv(table, [score.key for score in instrument.scores]), notes)


def _without_codes(
    instrument: Instrument, header: list[str], rows: list[_Row], missing: Collection[str]
) -> list[_Row]:
    """Return the rows with empty cells for the codes of missing answers; ids are left alone."""
    codes = {_cell(code) for code in missing} - {None}
    if not codes:
        return rows
    items = {
        at for at, name in enumerate(header) if _item_name(instrument, name) in instrument.by_key
    }
    return [
        _Row(
            row.line,
            [
                "" if at in items and _cell(cell) in codes else cell
                for at, cell in enumerate(row.cells)
            ],
        )
        for row in rows
    ]


def _notes_on_repeated_rows(rows: list[_Row]) -> tuple[str, ...]:
    """Return a sentence if rows are the same in every cell, as when a form was copied twice.

    Rows without anything that names the person may be the same by chance.
    """
    lines: dict[tuple[str, ...], list[int]] = {}
    for row in rows:
        lines.setdefault(tuple(cell.strip() for cell in row.cells), []).append(row.line)
    repeated = [own for own in lines.values() if len(own) > 1]
    if not repeated:
        return ()
    shown = "; ".join(" and ".join(map(str, own)) for own in repeated[:_NAMED_ROWS])
    more = f"; and {len(repeated) - _NAMED_ROWS} more" if len(repeated) > _NAMED_ROWS else ""
    note = (
        f"lines {shown}{more} are the same in every cell: was a form copied twice? Each was scored;"
        " if they are one form, remove all but one"
    )
    return (note,)


def _notes_on_repeated_ids(
    instrument: Instrument, header: list[str], rows: list[_Row]
) -> tuple[str, ...]:
    """Return a sentence if all ids of a row are those of another one, with other answers.

    Where every id recurs, the rows are repeated measures without a column for what was repeated;
    that is asked about only if a column is named like one of people.
    """
    items = set(_item_columns(instrument, header).values())
    ids = [at for at in range(len(header)) if at not in items]
    lines: dict[tuple[str, ...], list[_Row]] = {}
    for row in rows:
        lines.setdefault(tuple(row.cells[at].strip() for at in ids), []).append(row)
    repeated = {
        own: same
        for own, same in lines.items()
        if any(own) and len({tuple(row.cells) for row in same}) > 1
    }
    people = any(header[at].strip().casefold() in _NAMES_OF_PEOPLE for at in ids)
    if not repeated or not (people or 2 * len(repeated) <= len(lines)):
        return ()
    shown = "; ".join(
        f"{', '.join(filter(None, own))} in lines {' and '.join(str(row.line) for row in same)}"
        for own, same in list(repeated.items())[:_NAMED_ROWS]
    )
    more = f"; and {len(repeated) - _NAMED_ROWS} more" if len(repeated) > _NAMED_ROWS else ""
    note = (
        f"{shown}{more}: the same in {', '.join(header[at].strip() for at in ids)}, with other"
        " answers, and no column tells the rows apart. Each was scored; add a column such as the"
        " condition, or correct the id"
    )
    return (note,)


def _notes_on_answers(
    instrument: Instrument, header: list[str], cells: list[list[str]]
) -> tuple[str, ...]:
    """Return sentences on answers that hardly fit the instrument as a whole."""
    named = _item_columns(instrument, header)
    numeric = {key: at for key, at in named.items() if instrument.by_key[key].is_numeric}
    forms = [
        {
            key: as_number(instrument, instrument.by_key[key], _cell(row[at]))
            for key, at in numeric.items()
        }
        for row in cells
    ]
    turned = reversal_doubts(reversed_items(instrument), forms)
    note = (
        f"{'; '.join(turned)}. Each was reversed as its formula says; if the file has already"
        " reversed them, put the raw answers into it"
    )
    scales = [
        f"{doubt} They were scored as they are; if it was, convert them to this one first"
        for doubt in scale_doubts(instrument, forms)
    ]
    return (*((note,) if turned else ()), *scales)


def _notes_on_empty_scores(
    instrument: Instrument, header: list[str], rows: list[_Row], table: pd.DataFrame
) -> tuple[str, ...]:
    """Return a sentence for each score that lacks a value in some rows."""
    at = {_item_name(instrument, name): position for position, name in enumerate(header)}
    notes = []
    for key, needed in _items_of_scores(instrument).items():
        without = [row for row, value in zip(rows, table[key], strict=True) if value != value]
        if not without:
            continue
        absent = [item for item in needed if item not in at]
        if absent:
            why = f"there is no column {', '.join(absent)}"
        else:
            places = []
            for row in without[:_NAMED_ROWS]:
                empty = [item for item in needed if _cell(row.cells[at[item]]) is None]
                places.append(f"line {row.line} ({', '.join(empty) or 'division by zero'})")
            more = len(without) - len(places)
            why = f"{', '.join(places)}{f' and {more} more' if more else ''}"
            why = f"an answer that it needs is missing: {why}"
        notes.append(f"{len(without)} of {len(rows)} rows have no {key}; {why}")
    return tuple(notes)


def _items_of_scores(instrument: Instrument) -> dict[str, list[str]]:
    """Return score -> the items it needs, also through other scores, in the order of the items."""
    needed: dict[str, frozenset[str]] = {}
    for key, tree in instrument.formulas.items():
        names = names_in(tree)
        needed[key] = names.union(*(needed[name] for name in names & needed.keys()))
    return {key: [item for item in instrument.by_key if item in own] for key, own in needed.items()}


def _read(instrument: Instrument, text: str) -> tuple[str, list[str], list[_Row]]:
    lines = io.StringIO(text, newline="")
    first = next((line for line in lines if line.strip()), "")
    if not first:
        raise _empty_table_error(instrument)

    def n_items(separator: str) -> int:
        names = (cell.strip().strip('"') for cell in first.strip("\r\n").split(separator))
        return sum(_item_name(instrument, name) in instrument.by_key for name in names)

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
    if not rows:  # a line with only a quoted empty cell has text but gives no row
        raise _empty_table_error(instrument)
    return separator, rows[0].cells, rows[1:]


def _empty_table_error(instrument: Instrument) -> InstrumentTableError:
    return InstrumentTableError(
        "The table is empty. Give a header line with id columns and the items "
        + ", ".join(instrument.by_key)
        + "."
    )


def _read_cells(instrument: Instrument, separator: str, header: list[str], row: _Row) -> list[str]:
    """Return the cells; where ; separates them, spreadsheets write decimals with a comma."""
    if separator != ";":
        return row.cells
    return [
        cell.replace(",", ".") if _item_name(instrument, name) in instrument.by_key else cell
        for name, cell in zip(header, row.cells, strict=True)
    ]


def _check_rows(
    instrument: Instrument, separator: str, header: list[str], rows: list[_Row]
) -> None:
    """Raise InstrumentTableError with everything that is wrong with any row, by line."""
    items = [
        (at, instrument.by_key[key])
        for key, at in _item_columns(instrument, header).items()
        if instrument.by_key[key].is_numeric
    ]
    wrong: list[str] = []
    for number, row in enumerate(rows, start=1):
        if len(row.cells) != len(header):
            wrong.append(
                f"Line {row.line} has {len(row.cells)} cells, but the header has {len(header)}. "
                "Give every row one cell for each column, and put text with separators in quotes."
            )
            continue
        cells = _read_cells(instrument, separator, header, row)
        for at, item in items:
            try:
                as_number(instrument, item, _cell(cells[at]))
            except AnswerError as error:
                wrong.append(
                    f"Row {number} (line {row.line}), column {header[at].strip()}: the answer is "
                    f"{shortened(row.cells[at])!r}. Valid: {error.valid}, or an empty cell (or NA) "
                    "if it is missing."
                )
    if not wrong:
        return
    if len(wrong) == 1:
        raise InstrumentTableError(f"{wrong[0]} Correct it and score again; nothing was written.")
    more = [f"and {len(wrong) - _NAMED_PROBLEMS} more"] if len(wrong) > _NAMED_PROBLEMS else []
    raise InstrumentTableError(
        "\n  ".join(
            [
                f"{len(wrong)} mistakes; correct them and score again, nothing was written:",
                *wrong[:_NAMED_PROBLEMS],
                *more,
            ]
        )
    )


def _to_csv(table: pd.DataFrame, scores: list[str]) -> str:
    out = io.StringIO(newline="")
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(table.columns.tolist())
    for row in table.itertuples(index=False, name=None):
        ids, values = row[: -len(scores) or None], row[len(row) - len(scores) :]
        writer.writerow([*ids, *("" if value != value else repr(float(value)) for value in values)])
    return out.getvalue()


def score_table(instrument: Instrument, frame: pd.DataFrame) -> pd.DataFrame:
    """Return the scores of a table with one row for each completed form.

    `frame`: columns named like items (q1 or Q1) contain raw answers, as numbers or as text; all
    others are ids. Returns the ids unchanged, then one float column for each score (NaN: no value),
    with the same index. Without the column of an item, just the scores that need it are empty.

    Raises AnswerError with the row (from 1) for an invalid answer; InstrumentTableError if no
    column is an item, if a column is duplicated, or if an id is named like a score.
    """
    named = _item_columns(instrument, [str(name) for name in frame.columns])
    columns = {
        key: _numbers(instrument, instrument.by_key[key], frame.iloc[:, position])
        for key, position in named.items()
        if instrument.by_key[key].is_numeric
    }
    items = set(named.values())
    ids = frame.iloc[:, [at for at in range(frame.shape[1]) if at not in items]]
    clash = [score.key for score in instrument.scores if score.key in ids.columns]
    if clash:
        raise InstrumentTableError(
            f"The table already has a column {clash[0]!r}, which is the name of a score. "
            "Rename or remove that column."
        )
    scores = scores_of_columns(instrument, columns, rows=len(frame))
    return pd.concat([ids, pd.DataFrame(scores, index=frame.index, dtype=np.float64)], axis=1)


def _numbers(instrument: Instrument, item: Item, column: "pd.Series[float]") -> FloatArray:
    return np.array(
        [
            as_number(instrument, item, _cell(value), row=row)
            for row, value in enumerate(column.tolist(), start=1)
        ],
        dtype=np.float64,
    )


def _cell(value: object) -> object:
    """Convert a cell: text to a number if it is one, and the usual words for "missing" to None."""
    if value is pd.NA:
        return None
    if not isinstance(value, str):
        return value
    text = value.strip().lower()
    if text in _MISSING:
        return None
    if text in _YES_NO:
        return _YES_NO[text]
    # float() would also take "1_0", "inf" and digits of other scripts.
    if text.isascii() and "_" not in text and any(letter.isdigit() for letter in text):
        try:
            return float(text)
        except ValueError:
            return value
    return value


def _item_columns(instrument: Instrument, headers: Sequence[str]) -> dict[str, int]:
    """Return item key -> position of its column, ignoring case and surrounding blanks in headers.

    Raises InstrumentTableError if a column is duplicated or if no column is an item.
    """
    names = [_item_name(instrument, header) for header in headers]
    duplicates = [name for name, count in Counter(names).items() if count > 1]
    if duplicates:
        places = ", ".join(str(at + 1) for at, name in enumerate(names) if name == duplicates[0])
        raise InstrumentTableError(
            f"The column {duplicates[0]!r} occurs more than once (columns {places}). "
            "Keep the right one and remove the others."
        )
    found = {name: at for at, name in enumerate(names) if name in instrument.by_key}
    if not found:
        keys = ", ".join(instrument.by_key)
        given = ", ".join(headers) or "none"
        raise InstrumentTableError(
            f"No column is an item of {instrument.key}: the columns are {given}. "
            f"Name the answer columns after the items: {keys}."
        )
    return found


def _item_name(instrument: Instrument, header: str) -> str:
    """Return the key of the item that a header names; other headers unchanged."""
    name = header.strip()
    return name.lower() if name.lower() in instrument.by_key else header
