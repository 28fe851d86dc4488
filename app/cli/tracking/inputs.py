"""Read and write recorded poses: CSV with a line a sample.

    time_s, x_m, y_m, z_m, qw, qx, qy, qz [, tracked]

Times are by one clock for all files of a command; the world is right-handed with y up, as that of
WebXR. `tracked` is 0 where the tracking system guessed, so that the sample is not used for fitting.
"""

import csv
import io
from pathlib import Path

import numpy as np

from app.errors import missing_file
from app.science.alignment import AlignmentError, PoseStream

COLUMNS = ("time_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz")
_TRACKED = "tracked"
_MOST_BYTES = 500_000_000


def read_poses(path: Path) -> PoseStream:
    """Read the poses of a file; other columns are ignored.

    Raises:
        ValueError: a column is missing, or a line is not a pose, with file and line.
        OSError: it cannot be opened.
    """
    if not path.is_file():
        raise ValueError(missing_file(path))
    if path.stat().st_size > _MOST_BYTES:
        raise ValueError(f"{path}: {_MOST_BYTES // 1_000_000} MB are the most; cut it into parts")
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{path}: not a text in UTF-8 ({error})") from error
    reader = csv.reader(io.StringIO(text))
    header = [name.strip() for name in next(reader, [])]
    missing = [name for name in COLUMNS if name not in header]
    if missing:
        raise ValueError(
            f"{path}: the columns {', '.join(missing)} are missing; needed: {', '.join(COLUMNS)}"
        )
    wanted = [header.index(name) for name in COLUMNS]
    if _TRACKED in header:
        wanted.append(header.index(_TRACKED))
    rows = [_numbers(path, reader.line_num, row, wanted) for row in reader if row]
    table = np.array(rows, dtype=np.float64).reshape(len(rows), len(wanted))
    weights = (table[:, 8] > 0.0).astype(np.float64) if len(wanted) > 8 else None
    try:
        return PoseStream.of(table[:, 0], table[:, 1:4], table[:, 4:8], weights)
    except AlignmentError as error:
        raise ValueError(f"{path}: {error}") from error


def _numbers(path: Path, line: int, row: list[str], wanted: list[int]) -> list[float]:
    try:
        return [float(row[at]) for at in wanted]
    except (IndexError, ValueError) as error:
        raise ValueError(
            f"{path}, line {line}: {','.join(row)[:80]!r} is not a pose; each of"
            f" {', '.join(COLUMNS)} must be a number"
        ) from error


def write_poses(path: Path, poses: PoseStream) -> None:
    """Write poses without rounding; raise OSError if that fails."""
    table = np.column_stack((poses.times_s, poses.positions_m, poses.rotations, poses.weights > 0))
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow((*COLUMNS, _TRACKED))
        writer.writerows((*row[:-1], int(row[-1])) for row in table.tolist())
