"""Motive's CSV in every dialect, written from a movement, as real takes may not be shared."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from app.science.rig import RigMotion
from app.science.rotations import FloatArray, to_euler

_UNITS = {"Meters": 1.0, "Centimeters": 100.0, "Millimeters": 1000.0}


@dataclass(frozen=True)
class Dialect:
    """The differences between the versions and settings of Motive's export."""

    version: str = "1.23"
    rotation: str = "Quaternion"
    units: str = "Meters"
    space: str = "Global"
    labelled: bool = True
    parents: bool = False
    timecode: bool = False
    states_settings: bool = True
    """Whether the first row states rotation type, units and space."""
    mark: bool = False
    trailing_commas: int = 0
    start: str = "2025-12-25 12.21.50.291 PM"
    capture_rate_hz: float | None = None
    line_end: str = "\n"
    asset: str = "P01"
    markers: int = 0
    missing: tuple[tuple[int, int], ...] = ()
    """Pairs (frame, bone) that have no values."""


def motive_text(motion: RigMotion, dialect: Dialect) -> str:
    """Return a skeleton's movement as Motive writes it in this dialect."""
    columns = list(_columns(motion, dialect))
    first = _settings(motion, dialect) + "," * dialect.trailing_commas
    empty = "," * dialect.trailing_commas
    lead = ["", ""] + ([""] if dialect.timecode else [])
    titles = ["Type", "Name", "ID"] + (["Parent"] if dialect.parents else [])
    head = []
    for row, title in enumerate(titles):
        label = title if dialect.labelled else ""
        head.append(",".join(["", label, *lead[2:], *(column[0][row] for column in columns)]))
    head.append(",".join([*lead, *(column[0][-2] for column in columns)]))
    clock = ["TimeCode"] if dialect.timecode else []
    axes = [column[0][-1] for column in columns]
    head.append(",".join(["Frame", "Time (Seconds)", *clock, *axes]))
    body = []
    for frame in range(motion.frame_count):
        stamps = [str(frame), f"{frame / motion.rate_hz:.6f}"]
        stamps += ["15:26:46:12.02"] if dialect.timecode else []
        body.append(",".join([*stamps, *(column[1][frame] for column in columns)]))
    text = dialect.line_end.join([first, empty, *head, *body]) + dialect.line_end
    return ("\ufeff" if dialect.mark else "") + text


def _settings(motion: RigMotion, dialect: Dialect) -> str:
    capture = dialect.capture_rate_hz or motion.rate_hz
    pairs = [
        ("Format Version", dialect.version),
        ("Take Name", "Take 2025-12-25 10.51.23 AM"),
        ("Capture Frame Rate", f"{capture:.6f}"),
        ("Export Frame Rate", f"{motion.rate_hz:.6f}"),
        ("Capture Start Time", dialect.start),
        ("Total Exported Frames", str(motion.frame_count)),
    ]
    if dialect.states_settings:
        pairs += [
            ("Rotation Type", dialect.rotation),
            ("Length Units", dialect.units),
            ("Coordinate Space", dialect.space),
        ]
    return ",".join(f"{key},{value}" for key, value in pairs)


def _columns(motion: RigMotion, dialect: Dialect) -> Iterator[tuple[tuple[str, ...], list[str]]]:
    """Return (type, name, id, parent, kind, axis) and the cells of each column."""
    rig = motion.rig
    places, world = motion.world()
    turns = world
    if dialect.space == "Local":
        turns = motion.rotations
        places = np.broadcast_to(rig.offsets_m, places.shape).copy()
        places[:, 0] = motion.root_positions_m
    names = [f"{dialect.asset}:{name if j else dialect.asset}" for j, name in enumerate(rig.names)]
    for joint, name in enumerate(names):
        parent = names[rig.parents[joint]] if joint else "Root"
        lost = {frame for frame, bone in dialect.missing if bone == joint}
        for kind, axis, values in _numbers(places[:, joint], turns[:, joint], dialect):
            cells = [
                "" if frame in lost else f"{value:.9f}"
                for frame, value in enumerate(values.tolist())
            ]
            head = ("Bone", name, f"{joint:X}", *([parent] if dialect.parents else []))
            yield (*head, kind, axis), cells
    for marker in range(dialect.markers):
        for axis in "XYZ":
            head = ("Bone Marker", f"{dialect.asset}:M{marker}", f"F{marker:X}")
            parents = [""] if dialect.parents else []
            yield (*head, *parents, "Position", axis), ["0.1"] * motion.frame_count


def _numbers(
    places: FloatArray, turns: FloatArray, dialect: Dialect
) -> Iterator[tuple[str, str, FloatArray]]:
    if dialect.rotation == "Quaternion":
        for column, axis in zip((1, 2, 3, 0), "XYZW", strict=True):
            yield "Rotation", axis, turns[:, column]
    else:
        angles = np.degrees(to_euler(dialect.rotation, turns))
        for axis in "XYZ":
            yield "Rotation", axis, angles[:, dialect.rotation.index(axis)]
    for column, axis in enumerate("XYZ"):
        yield "Position", axis, places[:, column] * _UNITS[dialect.units]
