"""Read Vicon Tracker's CSV of objects: rotation vectors and positions of rigid bodies, z up.

    Objects
    100                                                       frames per second
    ,,Global Angle hip:hip,,,,,,Global Angle head:head,...    one object per six columns
    Frame,Sub Frame,RX,RY,RZ,TX,TY,TZ,RX,...
    ,,rad,rad,rad,mm,mm,mm,rad,...

RX, RY, RZ are a rotation vector, kept continuous, so that its length may exceed pi. No document
states this; it follows from rigidity: with this interpretation a person's hand keeps its position
in the frame of the elbow's object (3 % of the forearm), with any Euler order it moves (7 % and
more). A table ends at an empty line.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice, takewhile

import numpy as np

from app.adapters.captures.axes import turned_bodies
from app.adapters.captures.capture import (
    Capture,
    CaptureError,
    Convention,
    Conventions,
    Limits,
    Reading,
)
from app.adapters.captures.tables import check_places, csv_rows, read_numbers, unseen
from app.adapters.captures.text import text_lines
from app.adapters.captures.units import chosen_axes, chosen_length
from app.science.rig import BodyMotion, BoolArray
from app.science.rotations import FloatArray, from_rotation_vector

_COLUMNS = ("RX", "RY", "RZ", "TX", "TY", "TZ")
_METRES = {"mm": 0.001, "cm": 0.01, "m": 1.0}
_RADIANS = {"rad": 1.0, "deg": float(np.pi / 180.0)}
_Row = tuple[int, list[str]]


@dataclass(frozen=True)
class _Head:
    """The five header lines of a file of Vicon Tracker, which precede the numbers."""

    rate_hz: float
    names: tuple[str, ...]
    angle: str
    length: str


def read_vicon_tracker(data: bytes, *, name: str, reading: Reading, limits: Limits) -> Capture:
    """Read a CSV of objects exported by Vicon Tracker.

    Raises:
        CaptureError: the file cannot be read; the error gives the line and the reason.
    """
    del name
    rows = csv_rows(text_lines(data))
    head = _read_head(rows, limits)
    titles = [f"{column} of {body}" for body in head.names for column in _COLUMNS]
    columns = [(0, "Frame"), *((index, title) for index, title in enumerate(titles, 2))]
    filled = takewhile(lambda row: any(row[1]), rows)
    table = read_numbers(filled, columns, limits)
    times_s = _times(table.values[:, 0], table.lines, head.rate_hz)
    scale = reading.metres_per_unit or _METRES[head.length]
    cells = table.values[:, 1:].reshape(len(times_s), len(head.names), 6)
    missing = unseen(cells)
    places = np.where(missing[..., np.newaxis], np.nan, cells[..., 3:] * scale)
    check_places(places, table.lines, head.names)
    vectors = np.where(missing[..., np.newaxis], 0.0, cells[..., :3] * _RADIANS[head.angle])
    rotations = from_rotation_vector(np.clip(vectors, -1e3, 1e3))
    motion = BodyMotion(
        names=head.names,
        times_s=times_s,
        positions_m=places,
        rotations=np.where(missing[..., np.newaxis], np.nan, rotations),
    )
    conventions = Conventions(
        length=chosen_length(reading) or Convention(head.length, "file"),
        axes=chosen_axes(reading, Convention("z up, right-handed", "format")),
        rotations=Convention(f"rotation vector, {head.angle}", "file"),
        rate=Convention(f"{head.rate_hz:g} Hz", "file"),
    )
    notes = (*_gaps(missing, head.names), *_more_below(rows))
    return Capture(
        "vicon-tracker-csv", turned_bodies(motion, reading.up or "z"), conventions, notes
    )


def _read_head(rows: Iterator[_Row], limits: Limits) -> _Head:
    found = list(islice(rows, 5))
    if len(found) < 5:
        raise CaptureError(
            "the file ends before its columns: 'Objects', the rate, names, columns and units are"
            " the first five lines."
        )
    _, (rate_line, rate), (names_line, names), (columns_line, columns), (units_line, units) = found
    bodies = _names(names, names_line, limits)
    expected = list(_COLUMNS) * len(bodies)
    if columns[2 : 2 + len(expected)] != expected:
        raise CaptureError(
            f"the columns are not RX, RY, RZ, TX, TY, TZ for each of the {len(bodies)} objects.",
            line=columns_line,
        )
    angle, length = _units(units[2 : 2 + len(expected)], len(bodies), units_line)
    return _Head(_rate(rate, rate_line), bodies, angle, length)


def _rate(row: list[str], line: int) -> float:
    text = row[0].strip() if row else ""
    try:
        rate_hz = float(text)
    except ValueError:
        rate_hz = 0.0
    if not 0.01 <= rate_hz <= 1e5:
        raise CaptureError(f"the rate is {text[:40]!r}: frames a second are valid.", line=line)
    return rate_hz


def _names(row: list[str], line: int, limits: Limits) -> tuple[str, ...]:
    cells = [cell.strip() for cell in row[2::6]]
    while cells and not cells[-1]:
        cells.pop()
    names = tuple(_object_name(cell) for cell in cells)
    if not names or not all(names) or len(set(names)) != len(names):
        raise CaptureError(
            "the objects' names are missing or repeated: 'Global Angle NAME:NAME' every six"
            " columns is valid.",
            line=line,
        )
    if len(names) > limits.tracks:
        raise CaptureError(f"{len(names)} objects, up to {limits.tracks} are read.", line=line)
    return names


def _object_name(cell: str) -> str:
    full = cell.removeprefix("Global Angle").strip()
    subject, _, segment = full.partition(":")
    return segment if subject == segment else full


def _units(row: list[str], bodies: int, line: int) -> tuple[str, str]:
    padded = [*row, *[""] * (6 * bodies - len(row))]
    angles = {padded[6 * body + axis] for body in range(bodies) for axis in range(3)}
    lengths = {padded[6 * body + axis] for body in range(bodies) for axis in range(3, 6)}
    if len(angles) != 1 or not angles <= set(_RADIANS):
        raise CaptureError(f"the angles' units are {sorted(angles)[:4]}: rad or deg.", line=line)
    if len(lengths) != 1 or not lengths <= set(_METRES):
        raise CaptureError(f"the lengths' units are {sorted(lengths)[:4]}: mm, cm or m.", line=line)
    return angles.pop(), lengths.pop()


def _times(frames: FloatArray, lines: np.typing.NDArray[np.int64], rate_hz: float) -> FloatArray:
    wrong = np.flatnonzero(~(np.abs(frames) < 1e12))
    if wrong.size:
        raise CaptureError("the frame has no number.", line=int(lines[wrong[0]]))
    back = np.flatnonzero(np.diff(frames) < 1.0)
    if back.size:
        row = int(back[0]) + 1
        raise CaptureError(
            f"frame {frames[row]:g} comes after frame {frames[row - 1]:g}.", line=int(lines[row])
        )
    times_s: FloatArray = (frames - frames[0]) / rate_hz
    return times_s


def _gaps(missing: BoolArray, names: tuple[str, ...]) -> tuple[str, ...]:
    counts = missing.sum(axis=0).tolist()
    gaps = [f"{body} in {count}" for body, count in zip(names, counts, strict=True) if count]
    return (f"Not seen: {', '.join(gaps)} of {len(missing)} frames.",) if gaps else ()


def _more_below(rows: Iterator[_Row]) -> tuple[str, ...]:
    if any(any(row) for _, row in rows):
        return ("A second table below the objects was left out.",)
    return ()
