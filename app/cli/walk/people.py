"""Read the list of people of `reembody walk`: who walked, how tall, where, and with what.

A row is about one recording if it names a file, else about all recordings of a person. Of several
rows that are about a walk, the most particular one counts: that of its file and person, then that
of its file, then that of its person.
"""

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

from app.adapters.walks.walk_columns import UNKNOWN
from app.cli.walk.scenes import NamedScenes
from app.science.walking.records import is_name

_KNOWN_COLUMNS = ("subject", "stature_m", "file", "scene")
Key = TypeVar("Key")
Value = TypeVar("Value")
Row = tuple[str, str]
"""File and person that a row is about, each empty if it is about all."""


@dataclass(frozen=True)
class People:
    """The people who walked.

    Attributes:
        statures_m: stature by subject.
        subjects: subject by file name, for files that do not name one.
        scenes: key of the scene by row.
        numbers: further numbers by row.
        columns: the names of the columns that may be further numbers.
    """

    statures_m: dict[str, float] = field(default_factory=dict)
    subjects: dict[str, str] = field(default_factory=dict)
    scenes: dict[Row, str] = field(default_factory=dict)
    numbers: dict[Row, dict[str, float]] = field(default_factory=dict)
    columns: tuple[str, ...] = ()

    def scene_of(self, file: str, subject: str) -> str | None:
        """Return the scene of a person's walks in a file; None if no row says it."""
        found = (self.scenes.get(row) for row in _rows(file, subject))
        return next((scene for scene in found if scene is not None), None)

    def number_of(self, name: str, file: str, subject: str) -> float | None:
        """Return a further number of a person's walks in a file; None if no row says it."""
        found = (self.numbers.get(row, {}).get(name) for row in _rows(file, subject))
        return next((number for number in found if number is not None), None)


def _rows(file: str, subject: str) -> tuple[Row, ...]:
    return (file, subject), (file, ""), ("", subject)


def read_people(
    path: Path | None, scenes: NamedScenes | None = None, numbers: Sequence[str] = ()
) -> People:
    """Read a CSV with the columns subject, and optionally stature_m, file, scene and numbers.

    Args:
        path: the file; None for no list.
        scenes: finds the scenes that it names.
        numbers: the names of the columns that are read as further numbers.

    Raises:
        ValueError: a column is missing, a value is not a number, a scene does not exist, or two
            rows contradict each other.
        OSError: it cannot be opened.
    """
    people = People()
    if path is None:
        return people
    reader = csv.DictReader(io.StringIO(path.read_text(encoding="utf-8-sig")))
    names = list(reader.fieldnames or ())
    if "subject" not in names:
        raise ValueError(f"{path}: needs the columns subject, stature_m and, optionally, file.")
    found = People(
        columns=tuple(one for one in names if is_name(one) and one not in _KNOWN_COLUMNS)
    )
    for row in reader:
        at = f"{path}, line {reader.line_num}"
        cells = {name: (row.get(name) or "").strip() for name in names}
        subject, file = cells["subject"], cells.get("file", "")
        if stature := cells.get("stature_m"):
            found.statures_m[subject] = _number(stature, "stature_m", at)
        if file and subject:
            found.subjects[file] = subject
        if (scene := cells.get("scene")) and scenes is not None:
            key = scenes.find(scene, path.parent, at)
            _set(found.scenes, (file, subject), key, "scene", at)
        own = found.numbers.setdefault((file, subject), {})
        for name in numbers:
            if (cell := cells.get(name, "")).lower() not in UNKNOWN:
                _set(own, name, _number(cell, name, at), name, at)
    return found


def _number(cell: str, name: str, at: str) -> float:
    try:
        value = float(cell)
    except ValueError:
        value = float("nan")
    if not abs(value) < float("inf"):
        raise ValueError(f"{at}: {name} is {cell!r}, not a number.")
    return value


def _set(table: dict[Key, Value], key: Key, value: Value, what: str, at: str) -> None:
    before = table.setdefault(key, value)
    if before != value:
        raise ValueError(
            f"{at}: {what} is {value!r}, but an earlier row about the same says {before!r}. Keep"
            " one of them, or say in a column `file` which recording each is about."
        )
