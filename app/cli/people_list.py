"""Read lists of people, whose rows are about recordings, and match the rows with the recordings.

A row names a recording by its file's name, or by as much of its path as tells it apart. Of several
rows that match a recording the one with the most parts of its path counts.
"""

import csv
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from app.adapters.captures import CaptureError, number_of, text_lines

_NAMES_SHOWN = 6
Key = TypeVar("Key")
Value = TypeVar("Value")


@dataclass(frozen=True)
class ListedRow:
    """A row of a list: its cells by the names of the columns, and where it is, file and line."""

    cells: Mapping[str, str]
    at: str

    def number(self, name: str) -> float | None:
        """Return a finite number; None for an empty cell. Raises ValueError."""
        cell = self.cells.get(name, "")
        if not cell:
            return None
        value = number_of(cell)
        if not abs(value) < float("inf"):
            raise ValueError(f"{self.at}: {name} is {cell!r}, not a number.")
        return value


@dataclass(frozen=True)
class PeopleList:
    """The rows of a list, and the names of its columns as they are written."""

    path: Path
    columns: tuple[str, ...]
    rows: tuple[ListedRow, ...]


def read_list(path: Path, needed: Sequence[str], optional: Sequence[str]) -> PeopleList:
    """Read a list with a header; empty lines are skipped.

    Raises:
        ValueError: a column is missing or there twice, or a row has cells beyond its columns.
        OSError: it cannot be opened.
    """
    try:
        reader = csv.reader(text_lines(path.read_bytes(), keep_ends=True), strict=True)
        columns = tuple(cell.strip() for cell in next(reader, ()))
        _check_columns(path, columns, needed, optional)
        rows = []
        for cells in reader:
            at = f"{path}, line {reader.line_num}"
            if any(cell.strip() for cell in cells[len(columns) :]):
                raise ValueError(
                    f"{at}: {len(cells)} cells, but the list has {len(columns)} columns. Write"
                    " decimals with a point, and put a cell that contains a comma in quotes."
                )
            padded = [*cells, *("" for _ in columns)]
            if any(cell.strip() for cell in cells):
                named = {name: padded[at].strip() for at, name in enumerate(columns) if name}
                rows.append(ListedRow(named, at))
    except (CaptureError, csv.Error) as error:
        raise ValueError(f"{path}: {error}") from error
    return PeopleList(path, columns, tuple(rows))


def _check_columns(
    path: Path, columns: Sequence[str], needed: Sequence[str], optional: Sequence[str]
) -> None:
    missing = [name for name in needed if name not in columns]
    if missing:
        found = ", ".join(repr(name) for name in columns) or "none"
        hint = " Separate the columns by commas." if len(columns) == 1 else ""
        raise ValueError(
            f"{path}: has no column {' and '.join(missing)}; its first line names {found}. It needs"
            f" {', '.join(needed)} and, optionally, {', '.join(optional)}, as they are written"
            f" here.{hint}"
        )
    twice = sorted({name for name in columns if name and columns.count(name) > 1})
    if twice:
        raise ValueError(
            f"{path}: the column {', '.join(twice)} is there twice. Keep one of each name."
        )


def set_once(table: dict[Key, Value], key: Key, value: Value, what: str, at: str) -> None:
    """Set what a row says; raise ValueError if an earlier row says something else."""
    before = table.setdefault(key, value)
    if before != value:
        raise ValueError(
            f"{at}: {what} is {value!r}, but an earlier row about the same says {before!r}. Keep"
            " one of them, or say in a column `file` which recording each is about."
        )


def file_named(cell: str) -> str:
    """Return the name of a file in a row as it is compared: without `./` and the like."""
    return os.path.normpath(cell) if cell else ""


def matching(path: Path, names: Iterable[str]) -> list[str]:
    """Return the names with which the path of a recording ends, those of the most parts first."""
    whole = _whole(path).parts
    found = [name for name in names if whole[-len(Path(name).parts) :] == Path(name).parts]
    return sorted(found, key=lambda name: -len(Path(name).parts))


def labels_of(files: Sequence[Path]) -> dict[Path, str]:
    """Return for each file its name, with as much of its path as tells it from the others."""
    whole = {path: _whole(path).parts for path in files}
    found = {}
    for path, parts in whole.items():
        others = [other for other in whole.values() if other != parts]
        size = 1
        while size < len(parts) and any(one[-size:] == parts[-size:] for one in others):
            size += 1
        found[path] = "/".join(parts[-size:])
    return found


def require_matched(
    named: Mapping[str, str], files: Sequence[Path], said_nothing: Sequence[str]
) -> list[str]:
    """Return a notice of each row that is about none of the recordings.

    A list may be about recordings that are not used now. But if one is used of which it says
    nothing, its row is probably misspelt.

    Args:
        named: for each name of a file in the list, where it is named first.
        files: the recordings.
        said_nothing: those of which the list says nothing, by their labels.

    Raises:
        ValueError: a row may be misspelt, or is about several recordings.
    """
    about: dict[str, list[Path]] = {}
    for path in {_whole(one): one for one in files}.values():
        for name in matching(path, named)[:1]:
            about.setdefault(name, []).append(path)
    for name, paths in about.items():
        if len(paths) > 1:
            raise ValueError(
                f"{named[name]}: file is {name!r}, which is the end of {some_of(map(str, paths))}."
                " Write a row for each, with as much of its path as tells it apart."
            )
    idle = [name for name in named if not any(matching(path, [name]) for path in files)]
    if idle and said_nothing:
        raise ValueError(
            f"{named[idle[0]]}: file is {idle[0]!r}, but no recording has this name, and nothing"
            f" is said of {some_of(said_nothing)}. Correct the name: give a file's name, or as much"
            " of its path as tells it apart."
        )
    return [
        f"{named[name]}: file is {name!r}, and no recording has this name; the row was not used"
        for name in idle
    ]


def _whole(path: Path) -> Path:
    """Return an absolute path without `..`; links are not followed, since a list names them."""
    return Path(os.path.normpath(path.absolute()))


def some_of(names: Iterable[str]) -> str:
    """List the first of some names."""
    listed = list(names)
    return ", ".join(listed[:_NAMES_SHOWN]) + (", ..." if len(listed) > _NAMES_SHOWN else "")
