"""Read tracker files of UXF (Unity Experiment Framework): positions and Euler angles of objects.

    time,pos_x,pos_y,pos_z,rot_x,rot_y,rot_z                        one object, UXF's own tracker
    time,head_pos_x,...,head_rot_z,left_pos_x,...,grab,trigger      several, by a lab's own tracker

Unity is y up and left-handed, in metres. Its Euler angles are in degrees and rotate about z first,
then x, then y, all fixed axes: q = q_y q_x q_z. An object that is not tracked is written as all
zeros. A client with German settings writes `;` between columns and `,` in numbers; times count from
the start of the app.
"""

import re
from collections.abc import Sequence
from pathlib import PurePosixPath

import numpy as np

from app.adapters.captures.axes import mirrored_places, mirrored_rotations, turned_bodies
from app.adapters.captures.capture import (
    Capture,
    CaptureError,
    Convention,
    Conventions,
    Limits,
    Reading,
)
from app.adapters.captures.tables import (
    check_places,
    csv_rows,
    read_titles,
    unit_rotations,
    unseen,
)
from app.adapters.captures.text import text_lines
from app.adapters.captures.trackers import (
    BodyColumns,
    find_bodies,
    logged_rate,
    read_cells,
    still_notes,
)
from app.adapters.captures.units import chosen_axes, chosen_length
from app.science.rig import BodyMotion, BoolArray
from app.science.rotations import FloatArray, from_euler

_LEFT_HANDED = Convention("y up, left-handed", "format")


def read_uxf_tracker(data: bytes, *, name: str, reading: Reading, limits: Limits) -> Capture:
    """Read a tracker file of UXF.

    Raises:
        CaptureError: the file cannot be read; the error gives the line and the reason. Also for
            trackers without movement of bodies, such as gaze.
    """
    separator = _separator(data)
    # UXF does not quote: a quotation mark in a lab's own column is an ordinary character.
    rows = csv_rows(text_lines(data), separator, quoted=False)
    line, header = read_titles(rows)
    quaternions = any(title.lower().endswith("rot_w") for title in header)
    bodies = find_bodies(header, "pos_", "rot_", "wxyz" if quaternions else "xyz", limits)
    _check_columns(header, bodies, line)
    decimal = "." if separator == "," else ","
    found = read_cells(rows, header, 0, bodies, limits, decimal=decimal)
    names = [body.name or _object_name(name) for body in bodies]
    missing = unseen(found.cells) | np.asarray((found.cells == 0.0).all(axis=-1))
    seen = np.where(missing[..., np.newaxis], np.nan, found.cells)
    places = seen[..., :3] * (reading.metres_per_unit or 1.0)
    check_places(places, found.lines, names)
    rotations = unit_rotations(_quaternions(seen[..., 3:]), found.lines, names)
    motion = BodyMotion(
        names=tuple(names),
        times_s=found.times_s,
        positions_m=mirrored_places(places),
        rotations=mirrored_rotations(rotations),
    )
    notation = "quaternion x, y, z, w" if quaternions else "Unity's Euler y x z, degrees"
    conventions = Conventions(
        length=chosen_length(reading) or Convention("m", "format"),
        axes=chosen_axes(reading, _LEFT_HANDED, "left-handed"),
        rotations=Convention(notation, "format"),
        rate=logged_rate(motion.rate_hz),
    )
    notes = (*found.repairs, *_unseen_notes(names, missing), *still_notes(names, seen))
    turned = turned_bodies(motion, reading.up or "y")
    return Capture("uxf-tracker", turned, conventions, (*notes, *found.left_out))


def _separator(data: bytes) -> str:
    first = next((line for line in text_lines(data) if line.strip()), "")
    return max(",;\t", key=first.count)


def _check_columns(header: Sequence[str], bodies: Sequence[BodyColumns], line: int) -> None:
    if header[0].lower() != "time":
        raise CaptureError(f"the first column is {header[0]!r}, not 'time'.", line=line)
    if not bodies:
        shown = ", ".join(header[:12])
        raise CaptureError(
            "no body has a place and a rotation: the columns are"
            f" {shown}. A tracker of movement has pos_x, pos_y, pos_z and rot_x, rot_y, rot_z,"
            " each with an object's name before it where there are several.",
            line=line,
        )


def _quaternions(turns: FloatArray) -> FloatArray:
    """Convert Unity's angles (..., 3) x, y, z in degrees to wxyz; NaN stays.

    Quaternions (..., 4) are returned unchanged.
    """
    if turns.shape[-1] == 4:
        return turns
    angles = np.nan_to_num(np.fmod(turns, 360.0))
    q = from_euler("YXZ", np.radians(angles[..., [1, 0, 2]]))
    return np.where(np.isnan(turns).any(axis=-1, keepdims=True), np.nan, q)


def _object_name(file_name: str) -> str:
    """Return the object that a file tracks: `head_movement_T001.csv` tracks `head`."""
    stem = PurePosixPath(file_name.replace("\\", "/")).stem
    return re.sub(r"(_movement)?(_T\d+)?$", "", stem) or "tracker"


def _unseen_notes(names: Sequence[str], missing: BoolArray) -> tuple[str, ...]:
    counts = missing.sum(axis=0).tolist()
    return tuple(
        f"{name} was not tracked in {count} of {len(missing)} samples (all zeros or empty)."
        for name, count in zip(names, counts, strict=True)
        if count
    )
