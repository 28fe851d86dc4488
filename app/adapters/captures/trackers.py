"""Read the parts that logs of headsets share: a time column, and each body's pose columns.

Times count from the first sample and are strictly increasing.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.adapters.captures.capture import CaptureError, Convention, Limits
from app.adapters.captures.tables import read_numbers
from app.science.rotations import FloatArray

_LONGEST_S = 1e7


@dataclass(frozen=True, eq=False)
class SampleTimes:
    """The samples of a log: which rows to keep, their times, and what was repaired.

    Attributes:
        kept: (N,) indices of the rows whose time is later than that of the row before.
        times_s: (N,) times of these rows, counted from the first.
        notes: a sentence if rows were left out.
    """

    kept: npt.NDArray[np.intp]
    times_s: FloatArray
    notes: tuple[str, ...]


def sample_times(seconds: FloatArray, lines: npt.NDArray[np.int64]) -> SampleTimes:
    """Return times from the first sample on, leaving out rows that repeat a time.

    Raises:
        CaptureError: a time is missing or implausible, or the clock went backwards.
    """
    wrong = np.flatnonzero(~(np.abs(seconds) < 1e12))
    if wrong.size:
        raise CaptureError(
            f"the time is {seconds[wrong[0]]:g}: seconds are valid.", line=int(lines[wrong[0]])
        )
    times_s = seconds - seconds[0]
    steps = np.diff(times_s)
    back = np.flatnonzero(steps < 0.0)
    if back.size:
        row = int(back[0]) + 1
        raise CaptureError(
            f"the time goes back from {seconds[row - 1]:.6f} s to {seconds[row]:.6f} s: give one"
            " recording a file.",
            line=int(lines[row]),
        )
    if times_s[-1] > _LONGEST_S:
        raise CaptureError(f"the log spans {times_s[-1]:g} s: seconds are valid.")
    kept = np.flatnonzero(np.concatenate(([True], steps > 1e-9)))
    double = len(times_s) - len(kept)
    notes = (f"{double} rows repeat the time of the row before and were left out.",)
    return SampleTimes(kept, times_s[kept], notes if double else ())


def logged_rate(rate_hz: float) -> Convention:
    """Describe the sampling rate of a log, determined by the median step of its times."""
    if rate_hz <= 0.0:
        return Convention("one sample", "file")
    return Convention(f"{rate_hz:.4g} Hz by the median step", "file")


@dataclass(frozen=True)
class BodyColumns:
    """The column indices of a body: three coordinates, and three or four rotation values."""

    name: str
    places: tuple[int, ...]
    rotations: tuple[int, ...]


def find_bodies(
    header: Sequence[str], place: str, rotation: str, axes: Sequence[str], limits: Limits
) -> list[BodyColumns]:
    """Find the bodies in columns such as `head_pos_x` and `head_rot_x`.

    Args:
        header: the columns' titles.
        place, rotation: the end of the titles, before the axis: `pos_`, `rot_`.
        axes: the rotation's axes in the requested order, such as x, y, z.
        limits: the largest number of bodies.
    """
    index = {title.lower(): column for column, title in reversed(list(enumerate(header)))}
    first = re.compile(rf"^(.*?){re.escape(place)}x$", re.IGNORECASE)
    bodies: list[BodyColumns] = []
    for title in header:
        found = first.match(title)
        if found is None:
            continue
        stem = found[1].lower()
        places = [index.get(f"{stem}{place.lower()}{axis}") for axis in "xyz"]
        turns = [index.get(f"{stem}{rotation.lower()}{axis}") for axis in axes]
        whole_places = tuple(column for column in places if column is not None)
        whole_turns = tuple(column for column in turns if column is not None)
        if len(whole_places) == 3 and len(whole_turns) == len(axes):
            bodies.append(BodyColumns(found[1].strip("_ "), whole_places, whole_turns))
    names = [body.name for body in bodies]
    if len(set(names)) != len(names):
        raise CaptureError(f"bodies are named twice: {_listed(names)}.", line=1)
    if len(bodies) > limits.tracks:
        raise CaptureError(f"{len(bodies)} bodies, up to {limits.tracks} are read.", line=1)
    return bodies


@dataclass(frozen=True, eq=False)
class TrackedCells:
    """The numbers of a log, N samples of B bodies.

    Attributes:
        lines: (N,) line of each sample in the file.
        times_s: (N,) times, counted from the first sample.
        cells: (N, B, C) values: three coordinates, then the rotation, as in the file.
        repairs: notes on rows that were left out.
        left_out: a note that names the columns that are not movement.
    """

    lines: npt.NDArray[np.int64]
    times_s: FloatArray
    cells: FloatArray
    repairs: tuple[str, ...]
    left_out: tuple[str, ...]


def read_cells(
    rows: Iterable[tuple[int, list[str]]],
    header: Sequence[str],
    time: int,
    bodies: Sequence[BodyColumns],
    limits: Limits,
    *,
    decimal: str = ".",
) -> TrackedCells:
    """Read the time column and the bodies' columns.

    Raises:
        CaptureError: a row cannot be read; the error gives the line and the reason.
    """
    order = [time, *(column for body in bodies for column in (*body.places, *body.rotations))]
    columns = [(column, header[column]) for column in order]
    table = read_numbers(rows, columns, limits, decimal=decimal)
    clock = sample_times(table.values[:, 0], table.lines)
    cells = table.values[clock.kept, 1:].reshape(len(clock.kept), len(bodies), -1)
    others = [title for column, title in enumerate(header) if column not in order and title]
    return TrackedCells(
        lines=table.lines[clock.kept],
        times_s=clock.times_s,
        cells=cells,
        repairs=clock.notes,
        left_out=(f"Columns left out: {_listed(others)}.",) if others else (),
    )


def still_notes(names: Sequence[str], cells: FloatArray) -> tuple[str, ...]:
    """Return a note for each body in (N, B, C) that never moves, such as an unused controller."""
    if len(cells) < 10:
        return ()
    still = (cells == cells[:1]).all(axis=(0, 2))
    return tuple(
        f"{name} keeps one pose in the whole log: it was probably not in use."
        for name, same in zip(names, np.asarray(still).tolist(), strict=True)
        if same
    )


def _listed(titles: Sequence[str]) -> str:
    shown = ", ".join(titles[:8])
    return shown if len(titles) <= 8 else f"{shown} and {len(titles) - 8} more"
