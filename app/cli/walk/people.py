"""Read the list of people of `reembody walk`: who walked, how tall, where, and with what.

A row is about one recording if it names a file, else about all recordings of a person. Of several
rows that are about a walk, the most particular one counts: that of its file and person, then that
of its file, then that of its person; and of several names of its file the longest.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from app.adapters.walks.walk_columns import UNKNOWN
from app.cli.people_list import file_named, matching, read_list, set_once
from app.cli.walk.scenes import NamedScenes
from app.science.walking.records import is_name

_KNOWN_COLUMNS = ("subject", "stature_m", "file", "scene")
Row = tuple[str, str]
"""File and person that a row is about, each empty if it is about all."""


@dataclass(frozen=True)
class People:
    """The people who walked.

    Attributes:
        statures_m: stature by subject.
        subjects: the subjects of each file, with where the list says so.
        files: the names of files, with where each is named first.
        scenes: by row, each name that is given to its scene, with where.
        numbers: further numbers by row.
        columns: the names of the columns that may be further numbers.
        folder: where the list is: names of scenes are relative to it.
    """

    statures_m: dict[str, float] = field(default_factory=dict)
    subjects: dict[str, dict[str, str]] = field(default_factory=dict)
    files: dict[str, str] = field(default_factory=dict)
    scenes: dict[Row, list[tuple[str, str]]] = field(default_factory=dict)
    numbers: dict[Row, dict[str, float]] = field(default_factory=dict)
    columns: tuple[str, ...] = ()
    folder: Path = Path()

    def subject_of(self, path: Path) -> str | None:
        """Return whose a recording is that names nobody; None if no row says it.

        Raises:
            ValueError: rows of its file name several people.
        """
        for name in matching(path, self.subjects):
            (first, _), *others = self.subjects[name].items()
            if others:
                subject, at = others[0]
                raise ValueError(
                    f"{at}: the file {name!r} is of {subject!r}, but an earlier row says"
                    f" {first!r}, and the file itself does not name its people. Keep one of them."
                )
            return first
        return None

    def resolve(self, scenes: NamedScenes) -> None:
        """Find all scenes of the list.

        Raises:
            ValueError: there is no such scene, or two rows about the same name different ones.
            OSError: a scene's file cannot be opened.
        """
        known: dict[Row, str] = {}
        for row, named in self.scenes.items():
            for name, at in named:
                set_once(known, row, scenes.find(name, self.folder, at), "scene", at)

    def scene_of(self, path: Path, subject: str, scenes: NamedScenes) -> str | None:
        """Return the key of the scene of a person's walks in a file; None if no row says it.

        Raises:
            ValueError, OSError: as `NamedScenes.find`.
        """
        for row in self._rows(path, subject):
            if row in self.scenes:
                name, at = self.scenes[row][0]
                return scenes.find(name, self.folder, at)
        return None

    def number_of(self, name: str, path: Path, subject: str) -> float | None:
        """Return a further number of a person's walks in a file; None if no row says it."""
        found = (self.numbers.get(row, {}).get(name) for row in self._rows(path, subject))
        return next((number for number in found if number is not None), None)

    def mentions(self, path: Path, subject: str) -> bool:
        """Return whether a row is about a person's walks in a file."""
        return any(row in self.numbers for row in self._rows(path, subject))

    def _rows(self, path: Path, subject: str) -> Iterator[Row]:
        names = matching(path, self.files)
        yield from ((name, subject) for name in names)
        yield from ((name, "") for name in names)
        yield "", subject


def read_people(path: Path | None, numbers: Sequence[str] = ()) -> People:
    """Read a CSV with the columns subject, and optionally stature_m, file, scene and numbers.

    Args:
        path: the file; None for no list.
        numbers: the names of the columns that are read as further numbers.

    Raises:
        ValueError: a column is missing, a value is not a number, or two rows contradict each other.
        OSError: it cannot be opened.
    """
    if path is None:
        return People()
    listed = read_list(path, ("subject",), (*_KNOWN_COLUMNS[1:], "numbers such as load_kg"))
    found = People(
        columns=tuple(one for one in listed.columns if is_name(one) and one not in _KNOWN_COLUMNS),
        folder=path.parent,
    )
    for row in listed.rows:
        subject, file = row.cells["subject"], file_named(row.cells.get("file", ""))
        stature_m = row.number("stature_m")
        if stature_m is not None:
            set_once(found.statures_m, subject, stature_m, f"stature_m of {subject!r}", row.at)
        if file:
            found.files.setdefault(file, row.at)
        if file and subject:
            found.subjects.setdefault(file, {}).setdefault(subject, row.at)
        if scene := row.cells.get("scene"):
            found.scenes.setdefault((file, subject), []).append((scene, row.at))
        own = found.numbers.setdefault((file, subject), {})
        for name in numbers:
            if row.cells.get(name, "").lower() not in UNKNOWN:
                number = row.number(name)
                if number is not None:
                    set_once(own, name, number, name, row.at)
    return found
