"""Read movement logs of Oculus headsets: head and two controllers, position and quaternion.

    ...,LeftTouchPosX,...,LeftTouchOrientationW,...,HeadPosX,HeadPosY,HeadPosZ,HeadOrientationW,
    HeadOrientationX,HeadOrientationY,HeadOrientationZ,time

The Oculus SDK is y up and right-handed, looks along -z, and measures in metres from where the
headset was recentred, often at eye height. Times are in seconds.
"""

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
from app.adapters.captures.tables import (
    check_places,
    csv_rows,
    read_titles,
    unit_rotations,
    unseen,
)
from app.adapters.captures.text import text_lines
from app.adapters.captures.trackers import find_bodies, logged_rate, read_cells, still_notes
from app.adapters.captures.units import chosen_axes, chosen_length
from app.science.rig import BodyMotion


def read_quest_log(data: bytes, *, name: str, reading: Reading, limits: Limits) -> Capture:
    """Read a movement log of an Oculus headset.

    Raises:
        CaptureError: the file cannot be read; the error gives the line and the reason.
    """
    del name
    rows = csv_rows(text_lines(data))
    line, header = read_titles(rows)
    bodies = find_bodies(header, "Pos", "Orientation", "wxyz", limits)
    clocks = [column for column, title in enumerate(header) if title.lower() == "time"]
    if not bodies or not clocks:
        raise CaptureError(
            "a log needs the columns HeadPosX to HeadOrientationZ and time, in seconds.", line=line
        )
    names = tuple(body.name for body in bodies)
    found = read_cells(rows, header, clocks[0], bodies, limits)
    places = found.cells[..., :3] * (reading.metres_per_unit or 1.0)
    check_places(places, found.lines, names)
    rotations = unit_rotations(found.cells[..., 3:], found.lines, names)
    missing = unseen(places, rotations)[..., np.newaxis]
    motion = BodyMotion(
        names=names,
        times_s=found.times_s,
        positions_m=np.where(missing, np.nan, places),
        rotations=np.where(missing, np.nan, rotations),
    )
    conventions = Conventions(
        length=chosen_length(reading) or Convention("m", "format"),
        axes=chosen_axes(reading, Convention("y up, right-handed", "format")),
        rotations=Convention("quaternion w, x, y, z", "format"),
        rate=logged_rate(motion.rate_hz),
    )
    notes = (*found.repairs, *still_notes(names, found.cells), *found.left_out)
    return Capture("quest-log", turned_bodies(motion, reading.up or "y"), conventions, notes)
