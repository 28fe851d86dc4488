"""Read a CSV file as rows of a tidy table, each with its line number.

Only rows that fulfil every condition (`--where`) are read, and rows without a level of a factor are
left out: in an export, phases without a limb have no hand or foot. How many rows were left out, and
why, is part of the result.

Separators are commas, semicolons or tabs, detected in the header; with semicolons, numbers may have
a decimal comma (`decimals.py`). Invalid input is rejected with its line and column.
"""

import csv
import io
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import mode

from app.cli.analyse.decimals import read_numbers
from app.science.statistics import MISSING, UnusableTable, as_number, ordered_levels

_SEPARATORS = (",", ";", "\t")
_SHOWN = 60
_VALUES_SHOWN = 12
NAMES_OF_MEASURES = frozenset(
    {"measure", "score", "variable", "instrument", "scale", "subscale", "axis", "reference", "unit"}
)
"""Columns that say in words what a row measures: rows that differ in one are never averaged."""
NAMES_OF_REPETITIONS = frozenset(
    {"trial", "repetition", "repeat", "replicate", "rep", "run", "attempt", "round", "pass"}
    | {"block", "sample", "frame", "index", "number", "no", "n", "line", "row", "id", "order"}
)
"""Columns whose numbers count repeated observations, which may be averaged over; it is noted."""
NO_LEVEL = MISSING - {"none"}
"""Texts in a factor's column that mean that the row has no level of it."""


@dataclass(frozen=True)
class TidyInput:
    """The requested columns by name, as text, and the line of each row.

    Attributes:
        subjects, measure: one entry per row.
        within: each factor's column, in the requested order.
        lines: line numbers in the file, from 1; the header is line 1.
        replicates: how many rows duplicate an earlier one, in tables with several rows per cell.
        left_out: how many rows were left out, by reason.
    """

    subjects: list[str]
    within: dict[str, list[str]]
    measure: list[str]
    lines: list[int]
    replicates: int
    left_out: dict[str, int]
    told_apart_by: tuple[str, ...] = ()
    """Columns that tell the values of a cell apart, as of trials, and those averaged over."""
    averaged_words: Mapping[str, list[str]] = field(default_factory=dict)
    """The columns that may be averaged over, one entry per row."""
    spelt_otherwise: tuple[tuple[str, str, tuple[int, ...]], ...] = ()
    """Conditions, values spelt almost as theirs, and the lines that were left out for it."""
    read_as: tuple[str, ...] = ()
    """Sentences on columns whose decimal sign is not the point."""
    doubtful_numbers: tuple[str, ...] = ()
    """Doubts about what the signs in numbers mean."""
    unused_codes: tuple[str, ...] = ()
    """Codes of missing values that no cell of the measure has."""
    right_of_measure: tuple[str, list[str]] | None = None
    """In a table with commas, the column after the measure, if it is not analysed."""


@dataclass(frozen=True)
class _Row:
    line: int
    cells: list[str]


def read_tidy(
    path: Path,
    subject: str,
    within: list[str],
    measure: str,
    where: Sequence[str] = (),
    averaged: Sequence[str] = (),
    missing: Sequence[str] = (),
) -> TidyInput:
    """Read the named columns of the rows that fulfil every condition `COLUMN=VALUE`.

    `averaged` names columns whose words tell the rows of a cell apart and may be averaged over;
    `missing` are values of the measure that stand for a missing one, which are read as empty.

    Raises OSError if the file cannot be read, UnusableTable if it is not a table, lacks a column,
    has a duplicate row although all other cells have one row, has several measures in one cell, or
    no row fulfils a condition.
    """
    separator, header, rows = _table(path)
    requested = [subject, *within, measure]
    if len(set(requested)) != len(requested):
        raise UnusableTable(f"The columns asked for must all be different: {', '.join(requested)}.")
    for name in requested:
        _check_column(name, header)
    _check_averaged(averaged, header, requested)
    for row in rows:
        if len(row.cells) != len(header):
            commas = separator == "," and len(row.cells) > len(header)
            raise UnusableTable(
                f"Line {row.line} has {len(row.cells)} cells, but the header has {len(header)}."
                " Give every row one cell for each column, and put text with separators in quotes."
                + (" If numbers have decimal commas, separate with semicolons." if commas else "")
            )
    left_out = {}
    spelt_otherwise: list[tuple[str, str, tuple[int, ...]]] = []
    for condition in where:
        kept = _fulfilling(condition, header, rows)
        spelt_otherwise += _spelt_otherwise(condition, header, rows, kept)
        left_out[condition] = len(rows) - len(kept)
        rows = kept
    for name in within:
        kept = [row for row in rows if row.cells[header.index(name)].casefold() not in NO_LEVEL]
        left_out[f"no {name}"] = len(rows) - len(kept)
        if rows and not kept:
            raise UnusableTable(f"Column {name!r} is empty in every row that was asked for.")
        rows = kept
    lines = [row.line for row in rows]
    columns = {name: [row.cells[header.index(name)] for row in rows] for name in requested}
    numbers = {
        name: read_numbers(name, columns[name], lines, separator) for name in [*within, measure]
    }
    columns |= {name: one.cells for name, one in numbers.items()}
    keys = list(zip(*(columns[name] for name in [subject, *within]), strict=True))
    others = {
        name: [row.cells[at] for row in rows]
        for at, name in enumerate(header)
        if name not in requested
    }
    told_apart_by = _require_one_value(others, keys, averaged)
    return TidyInput(
        subjects=columns[subject],
        within={name: columns[name] for name in within},
        measure=["" if stands_for_missing(text, missing) else text for text in columns[measure]],
        lines=lines,
        replicates=_repeated(rows, keys),
        left_out={reason: count for reason, count in left_out.items() if count},
        told_apart_by=told_apart_by,
        averaged_words={name: others[name] for name in averaged},
        spelt_otherwise=tuple(spelt_otherwise),
        read_as=tuple(text for one in numbers.values() for text in one.read_as),
        doubtful_numbers=tuple(text for one in numbers.values() for text in one.doubts),
        unused_codes=tuple(
            code
            for code in missing
            if not any(stands_for_missing(text, (code,)) for text in columns[measure])
        ),
        right_of_measure=_right_of(measure, header, others) if separator == "," else None,
    )


def _right_of(
    measure: str, header: list[str], others: Mapping[str, list[str]]
) -> tuple[str, list[str]] | None:
    """Return the column after the measure, if it is not one of those that are analysed."""
    at = header.index(measure) + 1
    name = header[at] if at < len(header) else None
    return None if name is None or name not in others else (name, others[name])


def _check_averaged(averaged: Sequence[str], header: list[str], requested: list[str]) -> None:
    for name in averaged:
        _check_column(name, header)
        if name in requested:
            raise UnusableTable(f"Column {name!r} is analysed; it cannot be averaged over, too.")


def _require_one_value(
    others: dict[str, list[str]], keys: Sequence[tuple[str, ...]], averaged: Sequence[str]
) -> tuple[str, ...]:
    """Raise UnusableTable if columns that are not analysed say that values must not be averaged.

    Return the columns over which the values of a cell are averaged.
    """
    within_averaged = [
        (*key, *words)
        for key, *words in zip(keys, *(others[name] for name in averaged), strict=True)
    ]
    for name, words in others.items():
        _require_one_measure(name, words, keys)
        if name not in averaged:
            _require_no_parts(name, words, within_averaged)
    # What was asked for is said even if a mistyped word keeps it from telling every cell apart.
    several = len(set(keys)) < len(keys)
    return tuple(
        name
        for name, words in others.items()
        if _tells_apart(words, keys) or (several and name in averaged)
    )


def _require_one_measure(
    name: str, measures: Sequence[str], keys: Sequence[tuple[str, ...]]
) -> None:
    """Raise UnusableTable if a column names measures, and a cell of the design has several."""
    in_words = any(as_number(word) is None for word in measures if word)
    if name.casefold() not in NAMES_OF_MEASURES or not in_words:
        return
    first: dict[tuple[str, ...], str] = {}
    for key, measured in zip(keys, measures, strict=True):
        if first.setdefault(key, measured) != measured:
            found = ordered_levels(measures)
            shown = ", ".join(found[:_VALUES_SHOWN]) + (", ..." if found[_VALUES_SHOWN:] else "")
            raise UnusableTable(
                f"Column {name!r} names several measures for {', '.join(key)}: {first[key]!r} and"
                f" {measured!r}. Their mean would mean nothing; analyse one at a time with --where"
                f" '{name}=...'. There are: {shown}."
            )


def _require_no_parts(name: str, words: Sequence[str], keys: Sequence[tuple[str, ...]]) -> None:
    """Raise UnusableTable if a column's words tell the rows of every cell apart.

    Columns of repetitions are allowed, if what they contain are numbers.
    """
    if not _tells_apart(words, keys):
        return
    numbers = all(as_number(word) is not None for word in words)
    if numbers and _counts_repetitions(name):
        return
    listed = ordered_levels(words)
    shown = ", ".join(listed[:_VALUES_SHOWN]) + (", ..." if listed[_VALUES_SHOWN:] else "")
    raise UnusableTable(
        f"Column {name!r} tells the values of each cell apart: {shown}. If these are different"
        " measures, their mean would mean nothing: analyse one at a time with --where"
        f" '{name}=...'. If they are levels of a factor, name it with --within '{name}', or average"
        f" over it knowingly with --average '{name}'."
    )


def _tells_apart(words: Sequence[str], keys: Sequence[tuple[str, ...]]) -> bool:
    """Return whether words recur from cell to cell, each at most once, and most cells have all.

    They may be measures, items or levels of a further factor, in words or coded by whole numbers.
    Times and remarks do not recur so.
    """
    found, counts = set(words), Counter(keys)
    full = sum(count == len(found) for count in counts.values())
    if len(found) < 2 or 2 * full < len(counts):
        return False
    numbers = [number for number in map(as_number, found) if number is not None]
    if numbers and not (len(numbers) == len(found) and all(map(float.is_integer, numbers))):
        return False
    return "" not in found and len(set(zip(keys, words, strict=True))) == len(keys)


def _counts_repetitions(name: str) -> bool:
    parts = re.split(r"[^a-z]+", re.sub(r"([a-z])([A-Z])", r"\1_\2", name).casefold())
    return not NAMES_OF_REPETITIONS.isdisjoint(parts)


def _fulfilling(condition: str, header: list[str], rows: list[_Row]) -> list[_Row]:
    """Return the rows in which a column has a value; numbers are compared as numbers."""
    name, equals, wanted = (part.strip() for part in condition.partition("="))
    if not equals or not name:
        raise UnusableTable(f"{condition!r} is not a condition; write COLUMN=VALUE.")
    _check_column(name, header)
    place = header.index(name)
    number = as_number(wanted)
    kept = [
        row
        for row in rows
        if row.cells[place] == wanted
        or (number is not None and as_number(row.cells[place]) == number)
    ]
    if not kept:
        found = ordered_levels(row.cells[place] for row in rows)
        shown = ", ".join(found[:_VALUES_SHOWN]) + (", ..." if len(found) > _VALUES_SHOWN else "")
        raise UnusableTable(f"No row has {wanted!r} in column {name!r}; there are: {shown}.")
    return kept


def _spelt_otherwise(
    condition: str, header: list[str], rows: list[_Row], kept: list[_Row]
) -> list[tuple[str, str, tuple[int, ...]]]:
    """Return values that differ from the wanted one in capitals, spaces or dashes, with lines."""
    name, _, wanted = (part.strip() for part in condition.partition("="))
    place = header.index(name)
    lines: dict[str, list[int]] = {}
    taken = {row.line for row in kept}
    for row in rows:
        if row.line not in taken and plainly(row.cells[place]) == plainly(wanted):
            lines.setdefault(row.cells[place], []).append(row.line)
    return [(condition, value, tuple(own)) for value, own in lines.items()]


def stands_for_missing(text: str, codes: Sequence[str]) -> bool:
    """Return whether a cell is one of these codes; numbers are compared as numbers."""
    number = as_number(text)
    return any(text == code or (number is not None and as_number(code) == number) for code in codes)


def plainly(word: str) -> str:
    """Return a word without what a slip changes: capitals, spaces and dashes."""
    return re.sub(r"[\s_-]+", "", word.casefold())


def _table(path: Path) -> tuple[str, list[str], list[_Row]]:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise UnusableTable(f"{path} is not UTF-8 text; save it as CSV UTF-8.") from error
    first = next((line for line in text.splitlines() if line.strip()), "")
    if not first:
        raise UnusableTable(f"{path} is empty; its first line must name the columns.")
    separator = max(_SEPARATORS, key=first.count)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    rows: list[_Row] = []
    try:
        rows.extend(
            _Row(reader.line_num, [cell.strip() for cell in cells])
            for cells in reader
            if any(cell.strip() for cell in cells)
        )
    except csv.Error as error:
        raise UnusableTable(
            f"Line {reader.line_num} of {path} cannot be read: {error}. Close every quote."
        ) from error
    if not rows:
        raise UnusableTable(f"{path} has only empty cells; its first line must name the columns.")
    return separator, rows[0].cells, rows[1:]


def _check_column(name: str, header: list[str]) -> None:
    times = header.count(name)
    if times == 0:
        raise UnusableTable(f"There is no column {name!r}; there are: {', '.join(header)}.")
    if times > 1:
        raise UnusableTable(f"Column {name!r} occurs {times} times in the header; rename one.")


def _repeated(rows: list[_Row], keys: list[tuple[str, ...]]) -> int:
    """Count the rows that duplicate an earlier one.

    Raises UnusableTable for a duplicate if cells usually have one row.
    """
    seen: dict[tuple[str, ...], int] = {}
    repeated = 0
    usual = mode(Counter(keys).values()) if keys else 1
    for row in rows:
        cells = tuple(row.cells)
        if cells in seen:
            if usual == 1:
                content = ", ".join(cells)
                shown = content if len(content) <= _SHOWN else content[:_SHOWN] + " ..."
                raise UnusableTable(
                    f"Line {row.line} repeats line {seen[cells]} in every column ({shown}). Remove"
                    " one, or add a column that distinguishes the two observations."
                )
            repeated += 1
        seen.setdefault(cells, row.line)
    return repeated
