"""Read tracks on the floor from text tables: CSV with a header, or columns as in Juelich's archive.

A header names columns, in any case: `id` (or subject, person, participant, ped), `t`, `time`,
`time_s`, `time_ms` or `frame`, and `x`, `y`, each of these two with a unit if it is not metres
(`x_cm`, `y [mm]`, `x_ft`). Columns are separated by commas, semicolons, tabs or spaces; lines
beginning with # are comments, of which `framerate: 16` is read. A column `scene`, and those of
further numbers, say something about the walks (`walk_columns`); other columns are ignored.

Without a header the columns are id, frame, x, y (z) in centimetres, as in the trajectories of the
pedestrian dynamics data archive of Juelich. If time is a frame number, the rate must be known.
"""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from app.adapters.captures import CaptureError, number_of, text_lines
from app.adapters.walks.walk_columns import (
    WalkColumns,
    numbers_of,
    pieces,
    walk_columns,
)
from app.science.rotations import FloatArray
from app.science.walking.records import Kind, Track, WalkingError

MOST_ROWS, MOST_PEOPLE = 5_000_000, 20_000
LONGEST_GAP_S = 0.5
FASTEST_M_S = 12.0
"""Largest plausible median speed of a person; a faster track must be in another unit."""
LONGEST_STEP_S = 2.0
"""Longest time between samples as a rule: people take about two steps a second, so that is rare."""
UNITS_M = {"ft": 0.3048, "m": 1.0, "cm": 0.01, "mm": 0.001}
"""Metres per unit, by the names of units that a header may give."""
_IDS = ("id", "subject", "person", "participant", "ped", "pers_id", "agent")
_TIMES = {"t": 1.0, "time": 1.0, "time_s": 1.0, "t_s": 1.0, "time_ms": 0.001, "t_ms": 0.001}
_FRAMES = ("frame", "frame_id", "fr")
_NAME = re.compile(r"^([a-z_]+?)(?:[_ ]*[\[(]?(cm|mm|m|ft)[\])]?)?$")
_RATE = re.compile(r"frame\s*rate\D*([0-9]+(?:\.[0-9]+)?)", re.IGNORECASE | re.ASCII)


@dataclass(frozen=True)
class TrackReading:
    """A user's instructions for reading a table: facts that the table itself does not state.

    Attributes:
        rate_hz: frame rate, if time is a frame number.
        metres_per_unit: the unit of x and y; None to use the header's unit, or else metres.
        statures_m: stature by subject.
        kind: whether people or a program walked.
        numbers: the further numbers to read, which other columns may hold; None for all of them.
        scenes: whether a column `scene` is read.
    """

    rate_hz: float | None = None
    metres_per_unit: float | None = None
    statures_m: Mapping[str, float] = field(default_factory=dict)
    kind: Kind = "human"
    numbers: tuple[str, ...] | None = ()
    scenes: bool = True


@dataclass(frozen=True)
class _Layout:
    """The columns' indices and factors to SI; `person` is -1 if all rows are of one person.

    `time_name` is the name of the column of time; `assumed` is said about the file; `about` are the
    columns of scene and further numbers.
    """

    person: int
    time: int
    x: int
    y: int
    seconds: float
    metres: tuple[float, float]
    separator: str | None
    rows_from: int
    time_name: str = "the second"
    assumed: tuple[str, ...] = ()
    about: WalkColumns = field(default_factory=WalkColumns)


_AS_IT_IS = TrackReading()


@dataclass(frozen=True, eq=False)
class TrackTable:
    """The tracks of a table.

    Attributes:
        tracks: one for each person, or several where the scene changes or rows are missing.
        assumed: what had to be assumed because neither the table nor the user said it, and where
            tracks were cut because of gaps.
        scenes: the line at which each scene is first named.
        numbers: the names of the further numbers that it has.
        spoilt: what is wrong with columns that could have been further numbers.
        columns: the names of all columns that could be asked for as further numbers.
    """

    tracks: list[Track]
    assumed: tuple[str, ...]
    scenes: Mapping[str, int] = field(default_factory=dict)
    numbers: tuple[str, ...] = ()
    spoilt: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()


def read_tracks(data: bytes, *, name: str, reading: TrackReading = _AS_IT_IS) -> list[Track]:
    """Read the tracks of all people of a table: those of `read_track_table`."""
    return read_track_table(data, name=name, reading=reading).tracks


def read_track_table(data: bytes, *, name: str, reading: TrackReading = _AS_IT_IS) -> TrackTable:
    """Read the tracks of all people of a table, in the order in which they appear.

    A change of scene within the rows of a person begins another track, and so does a gap of more
    than `LONGEST_GAP_S` and three times the usual time between rows: that is how repeated trials
    are recorded, and a person may turn in it.

    Args:
        data: the content of the file.
        name: the name of the file, which becomes the source of the tracks.
        reading: the information that the file does not specify.

    Raises:
        CaptureError: (with the line) a missing column, a cell that is not a number, NaN, a person
            with only one sample, times that do not increase, times that are not in seconds,
            positions that are not in metres; a further number that was asked for is not one.
    """
    lines = list(text_lines(data))
    layout = _layout(lines, reading)
    people: dict[str, list[tuple[float, ...]]] = {}
    scenes: dict[str, list[str]] = {}
    for at in range(layout.rows_from, len(lines)):
        if lines[at].strip() and not lines[at].lstrip().startswith("#"):
            person, scene, sample = _sample(lines[at], at + 1, layout)
            people.setdefault(person, []).append((*sample, at + 1))
            if layout.about.scene >= 0:
                scenes.setdefault(person, []).append(scene)
            if len(people) > MOST_PEOPLE or at > MOST_ROWS:
                raise CaptureError(
                    f"more than {MOST_PEOPLE} people or {MOST_ROWS} rows: split it.", line=at + 1
                )
    if not people:
        raise CaptureError("the table has no rows.")
    tracks: list[Track] = []
    gaps: list[tuple[str, float, float]] = []
    for person, rows in people.items():
        for where, piece in pieces(scenes.get(person, []), np.array(rows), person):
            own, missing = _tracks(person, where, piece, name, reading, layout)
            tracks += own
            gaps += [(person, *gap) for gap in missing]
    about = layout.about
    return TrackTable(
        tracks,
        (*layout.assumed, *([_cut_at(gaps)] if gaps else [])),
        about.scenes,
        tuple(about.usable),
        tuple(about.spoilt),
        about.free,
    )


def _layout(lines: list[str], reading: TrackReading) -> _Layout:
    rate_hz, first = reading.rate_hz, 0
    while first < len(lines) and (not lines[first].strip() or lines[first].lstrip()[0] == "#"):
        if rate_hz is None and (stated := _RATE.search(lines[first])):
            rate_hz = float(stated.group(1))
        first += 1
    if first == len(lines):
        raise CaptureError("the file is empty.")
    separator = next((mark for mark in (";", "\t", ",") if mark in lines[first]), None)
    names = [cell.strip().strip('"') for cell in lines[first].split(separator)]
    cells = [name.lower() for name in names]
    if not any(cell and cell[0].isalpha() and cell != "nan" for cell in cells):
        if len(cells) not in (4, 5):
            raise CaptureError(
                f"{len(cells)} columns without a header: give a header with id, time, x, y.",
                line=first + 1,
            )
        unit = reading.metres_per_unit or UNITS_M["cm"]
        return _Layout(
            0,
            1,
            2,
            3,
            _step_s(rate_hz, first),
            (unit, unit),
            separator,
            first,
            assumed=()
            if reading.metres_per_unit
            else ("no header: the columns were taken as id, frame, x, y in centimetres",),
        )
    found = _named(cells, separator, first, rate_hz, reading)
    taken = (found.person, found.time, found.x, found.y)
    about = walk_columns(names, taken, reading.numbers, scenes=reading.scenes)
    return replace(found, about=about)


def _named(
    cells: list[str], separator: str | None, at: int, rate_hz: float | None, reading: TrackReading
) -> _Layout:
    person = next((cells.index(word) for word in _IDS if word in cells), -1)
    time = next(((cells.index(word), unit) for word, unit in _TIMES.items() if word in cells), None)
    if time is None:
        frame = next((cells.index(word) for word in _FRAMES if word in cells), None)
        if frame is None:
            valid = ", ".join((*_TIMES, *_FRAMES))
            raise CaptureError(f"no column of time: name one of {valid}.", line=at + 1)
        time = (frame, _step_s(rate_hz, at))
    found: dict[str, tuple[int, float]] = {}
    bare: list[str] = []
    for column, cell in enumerate(cells):
        match = _NAME.match(cell)
        if match and match.group(1) in ("x", "y"):
            unit = reading.metres_per_unit or UNITS_M[match.group(2) or "m"]
            if match.group(1) not in found and match.group(2) is None:
                bare.append(match.group(1))
            found.setdefault(match.group(1), (column, unit))
    missing = [axis for axis in ("x", "y") if axis not in found]
    if missing:
        raise CaptureError(
            f"no column {' and '.join(missing)}: there are {', '.join(cells)}.", line=at + 1
        )
    (x, x_unit), (y, y_unit) = found["x"], found["y"]
    assumed = []
    if bare and reading.metres_per_unit is None:
        which = "columns x and y name" if len(bare) > 1 else f"column {bare[0]} names"
        assumed.append(f"the {which} no unit: taken as metres")
    if cells[time[0]] in ("t", "time"):
        assumed.append(f"the column {cells[time[0]]} names no unit: taken as seconds")
    return _Layout(
        person,
        time[0],
        x,
        y,
        time[1],
        (x_unit, y_unit),
        separator,
        at + 1,
        cells[time[0]],
        tuple(assumed),
    )


def _step_s(rate_hz: float | None, at: int) -> float:
    if rate_hz is None or not 0.0 < rate_hz < math.inf:
        raise CaptureError(
            "time is a frame number, but the frame rate is not specified: give the rate in hertz.",
            line=at + 1,
        )
    return 1.0 / rate_hz


def _sample(line: str, number: int, layout: _Layout) -> tuple[str, str, tuple[float, ...]]:
    """Return the person and the scene of a row, and its time, place and further numbers."""
    cells = line.split(layout.separator)
    columns = (layout.time, layout.x, layout.y)
    if len(cells) <= max(*columns, layout.person):
        raise CaptureError(f"the row has {len(cells)} columns only.", line=number)
    values = []
    for column in columns:
        value = number_of(cells[column].strip().strip('"'))
        if not math.isfinite(value):
            raise CaptureError(
                f"column {column + 1} contains {cells[column].strip()!r}, not a finite number:"
                " leave out rows in which a person was not seen.",
                line=number,
            )
        values.append(value)
    person = cells[layout.person].strip().strip('"') if layout.person >= 0 else "1"
    time_s = values[0] * layout.seconds
    scene, others = layout.about.read(cells, number)
    place = (values[1] * layout.metres[0], values[2] * layout.metres[1])
    return person, scene, (time_s, *place, *others)


def _tracks(
    person: str,
    scene: str | None,
    rows: FloatArray,
    name: str,
    reading: TrackReading,
    layout: _Layout,
) -> tuple[list[Track], list[tuple[float, float]]]:
    """Return the tracks of one person in one scene, and begin and length of the gaps between them.

    Rows (N, c) are the time, the place, the further numbers and the line.
    """
    _check_times(person, rows, layout)
    with np.errstate(over="ignore"):
        waits_s = np.diff(rows[:, 0])
        steps_m = np.linalg.norm(np.diff(rows[:, 1:3], axis=0), axis=1)
        speed = float(np.median(steps_m / waits_s)) if len(rows) > 1 else 0.0
    if speed > FASTEST_M_S:
        raise CaptureError(
            f"person {person!r} moves at {speed:.0f} m/s as a rule: positions are not in metres, or"
            " the rate is not right. Say the unit, or the rate."
        )
    usual_s = float(np.median(waits_s)) if len(rows) > 1 else 0.0
    gaps = np.flatnonzero(waits_s > max(LONGEST_GAP_S, 3.0 * usual_s))
    found = []
    for part in np.split(rows, gaps + 1):
        if len(gaps) and len(part) == 1:
            # Between two gaps, one sample is no movement.
            continue
        try:
            track = Track(
                part[:, 0] - part[0, 0],
                part[:, 1:3],
                person,
                name,
                reading.kind,
                reading.statures_m.get(person),
                scene,
                numbers_of(layout.about, part[:, 3:-1]),
            )
        except WalkingError as error:
            raise CaptureError(str(error)) from error
        found.append(track)
    return found, [(float(rows[at, 0]), float(waits_s[at])) for at in gaps]


def _check_times(person: str, rows: FloatArray, layout: _Layout) -> None:
    """Raise CaptureError unless times increase, a few in each second."""
    times_s = rows[:, 0]
    with np.errstate(over="ignore"):
        waits_s = np.diff(times_s)
    late = np.flatnonzero(waits_s <= 0.0)
    if len(late):
        before_s, after_s = times_s[late[0]], times_s[late[0] + 1]
        raise CaptureError(
            f"the time of person {person!r} goes from {before_s:.10g} s to {after_s:.10g} s; it"
            " has to increase from row to row. Sort the rows by time. If another recording of this"
            " person begins here, let its times go on after those before, or give it its own file.",
            line=int(rows[late[0] + 1, -1]),
        )
    if len(waits_s) and (usual_s := float(np.median(waits_s))) > LONGEST_STEP_S:
        raise CaptureError(
            f"the samples of person {person!r} are {usual_s:.3g} s apart as a rule, by the column"
            f" {layout.time_name}; people take two steps a second. If these are milliseconds, name"
            " the column time_ms; if they are numbers of frames, name it frame and give the rate."
        )


def _cut_at(gaps: Sequence[tuple[str, float, float]]) -> str:
    """Say where tracks were cut: person, begin and length of each gap."""
    person, from_s, long_s = gaps[0]
    first = f"person {person!r} was not seen for {long_s:.2f} s from {from_s:.2f} s on"
    if len(gaps) == 1:
        return f"{first}: cut there, as where a recording ends and another begins"
    people = len({name for name, _, _ in gaps})
    whom = "" if people == 1 else f" of {people} people"
    return (
        f"there are {len(gaps)} gaps{whom}, such as the first: {first}. Tracks are cut there, as"
        " where a recording ends and another begins"
    )
