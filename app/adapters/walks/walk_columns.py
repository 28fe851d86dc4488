"""The columns of a table of tracks that are about walks: the scene, and further numbers.

A column `scene` names where each row was walked; a change of it within a person's rows begins
another track. Any other column may be a further number, such as `load_kg`; empty cells and `nan`
say that it is not known there. Numbers that the user names have to be numbers; else those columns
are taken that are.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from app.adapters.captures import CaptureError, number_of
from app.science.rotations import FloatArray
from app.science.walking.records import WalkingError, check_name, is_name

SCENE = "scene"
UNKNOWN = ("", "nan", "na")


@dataclass(eq=False)
class WalkColumns:
    """The columns of a table's scene and further numbers, and what was found in them.

    Attributes:
        scene: index of the column of scenes; -1 without one.
        numbers: index of each column of numbers, by its name.
        required: whether these columns have to be numbers.
        free: the names of all columns that could be further numbers.
        scenes: the line at which each scene is first named.
        not_numbers: the first cell of each column that turned out not to be one of numbers.
        seen: the columns in which there was a number.
        twice: names that several columns have, so that none of them counts.
    """

    scene: int = -1
    numbers: dict[str, int] = field(default_factory=dict)
    required: bool = False
    free: tuple[str, ...] = ()
    scenes: dict[str, int] = field(default_factory=dict)
    not_numbers: dict[str, str] = field(default_factory=dict)
    seen: set[str] = field(default_factory=set)
    twice: tuple[str, ...] = ()

    def read(self, cells: Sequence[str], line: int) -> tuple[str, list[float]]:
        """Return the scene and the numbers of a row; raise CaptureError with its line."""
        scene = _cell(cells, self.scene)
        if scene:
            self.scenes.setdefault(scene, line)
        return scene, [self._number(name, _cell(cells, at), line)
                       for name, at in self.numbers.items()]  # fmt: skip

    def _number(self, name: str, cell: str, line: int) -> float:
        if cell.lower() in UNKNOWN:
            return math.nan
        value = number_of(cell)
        if math.isfinite(value):
            self.seen.add(name)
            return value
        told = f"column {name} contains {cell!r}, not a finite number"
        if self.required:
            raise CaptureError(f"{told}: leave the cell empty if it is not known.", line=line)
        self.not_numbers.setdefault(name, f"line {line}: {told}")
        return math.nan

    @property
    def usable(self) -> list[str]:
        """The names of the columns that contain numbers, and nothing else."""
        return [
            name
            for name in self.numbers
            if name in self.free and name in self.seen and name not in self.not_numbers
        ]

    @property
    def spoilt(self) -> list[str]:
        """What is wrong with columns that contain numbers: other cells, their name, or a twin."""
        own = [told for name, told in self.not_numbers.items() if name in self.seen]
        badly_named = (name for name in self.numbers if not is_name(name))
        own += [_misnamed(name) for name in badly_named if name in self.seen]
        return [*own, *(f"the column {name} is there twice: keep one" for name in self.twice)]


def walk_columns(
    names: Sequence[str],
    taken: Sequence[int],
    wanted: Sequence[str] | None,
    *,
    scenes: bool = True,
) -> WalkColumns:
    """Choose the columns about walks of a header.

    Args:
        names: the names of all columns, as they are written.
        taken: indices of the columns of person, time and place.
        wanted: the further numbers that are read; None for all columns that are numbers.
        scenes: whether a column of scenes is read.

    Raises:
        CaptureError: a column that is read is there twice.
    """
    found = (at for at, name in enumerate(names) if scenes and name.lower() == SCENE)
    scene = next(found, -1)
    free = [(name, at) for at, name in enumerate(names) if at not in (*taken, scene)]
    twice = {name for name in names if name and names.count(name) > 1}
    read = {names[at] for at in (*taken, scene) if at >= 0} | {*(wanted or ())}
    if both := sorted(twice & read):
        raise CaptureError(f"the column {', '.join(both)} is there twice: keep one of each name.")
    valid = tuple(name for name, _ in free if is_name(name) and name not in twice)
    if wanted is None:
        own = {name: at for name, at in free if name and name not in twice}
        return WalkColumns(scene, own, free=valid, twice=tuple(sorted(twice)))
    chosen = {name: at for name, at in free if name in wanted}
    return WalkColumns(scene, chosen, required=True, free=valid)


def _misnamed(name: str) -> str:
    """Return why a column of numbers cannot be asked for by its name."""
    try:
        check_name(name)
    except WalkingError as error:
        return f"the column {name!r} was passed over. {str(error).rstrip('.')}"
    return ""


def pieces(
    scenes: Sequence[str], rows: FloatArray, person: str
) -> Iterator[tuple[str | None, FloatArray]]:
    """Cut a person's rows (N, c) where the scene changes; each piece with its scene.

    Raises:
        CaptureError: a piece has a single row, which is no movement.
    """
    changes = [at for at in range(1, len(rows)) if scenes and scenes[at] != scenes[at - 1]]
    for begin, end in zip([0, *changes], [*changes, len(rows)], strict=True):
        scene = scenes[begin] if scenes else ""
        if changes and end - begin == 1:
            raise CaptureError(
                f"person {person!r} is in scene {scene!r} for one row only, at"
                f" {rows[begin, 0]:.2f} s: check the column {SCENE}."
            )
        yield scene or None, rows[begin:end]


def numbers_of(columns: WalkColumns, values: FloatArray) -> dict[str, FloatArray]:
    """Return the usable numbers (N,) by name, from the values (N, c) of all number columns."""
    names = list(columns.numbers)
    return {
        name: np.ascontiguousarray(values[:, names.index(name)])
        for name in columns.usable
        if np.isfinite(values[:, names.index(name)]).any()
    }


def _cell(cells: Sequence[str], at: int) -> str:
    return cells[at].strip().strip('"').strip() if 0 <= at < len(cells) else ""
