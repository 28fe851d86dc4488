"""What the logs of headsets share: a time column, and columns of place and rotation a body."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.adapters.captures.capture import CaptureError, Limits
from app.adapters.captures.clock import sample_times
from app.adapters.captures.tables import read_numbers
from app.science.rotations import FloatArray


@dataclass(frozen=True)
class BodyColumns:
    """Where a body's numbers stand: three places and three or four rotations, by index."""

    name: str
    places: tuple[int, ...]
    rotations: tuple[int, ...]


def find_bodies(
    header: Sequence[str], place: str, rotation: str, axes: Sequence[str], limits: Limits
) -> list[BodyColumns]:
    """Find the bodies among columns such as `head_pos_x` and `head_rot_x`.

    Args:
        header: the columns' titles.
        place, rotation: how the titles end, before the axis: `pos_`, `rot_`.
        axes: the rotation's axes in the order wanted, such as x, y, z.
        limits: how many bodies are read.
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
        times_s: (N,) from the first sample on.
        cells: (N, B, C) three places, then the rotation, as written.
        repairs: notes on rows left out.
        left_out: a note that names the columns which are no movement.
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
    """Read the time, by its column, and the bodies' numbers.

    Raises:
        CaptureError: the line and the reason.
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
    """A note for each body that never moves, (N, B, C): a controller that was switched off."""
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
