"""Read the numbers of the chosen tracks of a Motive CSV as positions and rotations."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.adapters.captures.capture import CaptureError, Convention, Limits
from app.adapters.captures.motive.head import Head, Track
from app.adapters.captures.tables import NumberTable, read_numbers, unit_rotations
from app.science.rotations import FloatArray, from_euler

_ORDERS = frozenset({"XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"})


@dataclass(frozen=True, eq=False)
class TakeValues:
    """The values of T tracks in the N rows of a take.

    Attributes:
        lines: (N,) line of each row.
        frames: (N,) the file's frame numbers.
        times_s: (N,) the file's times, rounded to a millisecond or so.
        places: (N, T, 3) positions in the file's unit, NaN where not visible.
        rotations: (N, T, 4) wxyz, NaN where not visible; T = 0 if tracks have none.
        turned_by: the convention of the rotations.
    """

    lines: npt.NDArray[np.int64]
    frames: FloatArray
    times_s: FloatArray
    places: FloatArray
    rotations: FloatArray
    turned_by: Convention


def read_values(
    rows: Iterable[tuple[int, list[str]]], head: Head, tracks: Sequence[Track], limits: Limits
) -> TakeValues:
    """Read the tracks' columns of every row.

    Raises:
        CaptureError: a row cannot be read; the error gives the line and the reason.
    """
    turned = all(track.turned for track in tracks)
    axes = [*"XYZ", *(_axes(tracks) if turned else "")]
    columns = [(0, "Frame"), (1, "Time")]
    for track in tracks:
        cells = [track.place[axis] for axis in "XYZ"]
        cells += [track.turn[axis] for axis in axes[3:]]
        columns += [
            (cell, f"{axis} of {track.name}") for cell, axis in zip(cells, axes, strict=True)
        ]
    table = read_numbers(rows, columns, limits)
    cells_of = table.values[:, 2:].reshape(len(table.lines), len(tracks), len(axes))
    rotations, turned_by = _rotations(cells_of[..., 3:], head, table, tracks)
    _check_frames(table)
    return TakeValues(
        lines=table.lines,
        frames=table.values[:, 0],
        times_s=table.values[:, 1],
        places=cells_of[..., :3],
        rotations=rotations,
        turned_by=turned_by,
    )


def _axes(tracks: Sequence[Track]) -> str:
    quaternions = {"W" in track.turn for track in tracks}
    if len(quaternions) != 1:
        raise CaptureError("some tracks have quaternions and some Euler angles: export one kind.")
    return "WXYZ" if quaternions.pop() else "XYZ"


def _rotations(
    cells: FloatArray, head: Head, table: NumberTable, tracks: Sequence[Track]
) -> tuple[FloatArray, Convention]:
    names = [track.name for track in tracks]
    if cells.shape[-1] == 0:
        return np.empty((len(cells), 0, 4)), Convention("none", "file")
    if cells.shape[-1] == 4:
        return unit_rotations(cells, table.lines, names), Convention(
            "quaternion x, y, z, w", "file"
        )
    stated = head.settings.get("rotation type", "").upper()
    order = stated if stated in _ORDERS else "XYZ"
    angles = np.nan_to_num(np.fmod(cells, 360.0))[..., ["XYZ".index(axis) for axis in order]]
    q = from_euler(order, np.radians(angles))
    unseen = np.isnan(cells).any(axis=-1, keepdims=True)
    origin = Convention(f"Euler {order}, degrees", "file" if stated in _ORDERS else "guessed")
    return np.where(unseen, np.nan, q), origin


def _check_frames(table: NumberTable) -> None:
    frames = table.values[:, 0]
    wrong = np.flatnonzero(~(np.abs(frames) < 1e12))
    if wrong.size:
        raise CaptureError("the frame has no number.", line=int(table.lines[wrong[0]]))
    back = np.flatnonzero(np.diff(frames) < 1.0)
    if back.size:
        row = int(back[0]) + 1
        raise CaptureError(
            f"frame {frames[row]:g} comes after frame {frames[row - 1]:g}.",
            line=int(table.lines[row]),
        )
