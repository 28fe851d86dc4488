"""Export a movement as a table: a row per frame, a column per number, units in the titles.

Positions are in metres in the world, y up and right-handed; rotations are unit quaternions w, x, y,
z, world_from_joint, so that a row can be read without the hierarchy. Cells of values that were not
visible are empty.
"""

import csv
import io
from collections.abc import Iterator, Sequence

import numpy as np

from app.science.rig import BodyMotion, MarkerMotion, RigMotion, to_world
from app.science.rotations import FloatArray

_BLOCK_FRAMES = 512
_PLACES = ("x_m", "y_m", "z_m")
_TURNS = ("qw", "qx", "qy", "qz")


def to_csv(motion: RigMotion | MarkerMotion | BodyMotion) -> Iterator[str]:
    """Yield a CSV text in pieces of whole rows: the titles first, then some hundred frames each.

    Columns: `frame` from 0, `time_s`, then for each joint, marker or body `NAME.x_m`, `NAME.y_m`,
    `NAME.z_m` and, except for markers, `NAME.qw`, `NAME.qx`, `NAME.qy`, `NAME.qz`. A skeleton's
    frames end with `observed`: 1 if all joints were in the file, 0 if some were interpolated over a
    gap.
    """
    yield _text([_titles(motion)])
    for start in range(0, motion.frame_count, _BLOCK_FRAMES):
        block = slice(start, min(start + _BLOCK_FRAMES, motion.frame_count))
        values = _values(motion, block)
        times = _times(motion, block)
        rows = [
            [str(frame), f"{time:.6f}", *(_number(value) for value in row)]
            for frame, time, row in zip(
                range(block.start, block.stop), times.tolist(), values.tolist(), strict=True
            )
        ]
        if isinstance(motion, RigMotion):
            carried = np.count_nonzero(~motion.observed[block], axis=1).tolist()
            rows = [[*row, str(int(not n))] for row, n in zip(rows, carried, strict=True)]
        yield _text(rows)


def _titles(motion: RigMotion | MarkerMotion | BodyMotion) -> list[str]:
    names: Sequence[str] = motion.rig.names if isinstance(motion, RigMotion) else motion.names
    parts = _PLACES if isinstance(motion, MarkerMotion) else (*_PLACES, *_TURNS)
    titles = ["frame", "time_s", *(f"{name}.{part}" for name in names for part in parts)]
    return [*titles, "observed"] if isinstance(motion, RigMotion) else titles


def _times(motion: RigMotion | MarkerMotion | BodyMotion, block: slice) -> FloatArray:
    if isinstance(motion, BodyMotion):
        return motion.times_s[block]
    return np.arange(block.start, block.stop) / motion.rate_hz


def _values(motion: RigMotion | MarkerMotion | BodyMotion, block: slice) -> FloatArray:
    """Return the numbers of a block of frames, (n, columns)."""
    if isinstance(motion, MarkerMotion):
        cells = motion.positions_m[block]
    elif isinstance(motion, BodyMotion):
        cells = np.concatenate((motion.positions_m[block], motion.rotations[block]), axis=-1)
    else:
        placed = to_world(motion.rig, motion.root_positions_m[block], motion.rotations[block])
        cells = np.concatenate(placed, axis=-1)
    return cells.reshape(len(cells), -1)


def _number(value: float) -> str:
    # Nine significant digits; a NaN, which differs from itself, becomes an empty cell.
    return f"{value:.9g}" if value == value else ""


def _text(rows: Sequence[Sequence[str]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()
