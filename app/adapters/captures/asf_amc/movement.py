"""Parse an AMC file: the rows of an Acclaim movement, one line for each bone in each frame.

1 root 10.4194 16.7048 -30.1003 -2.48972 -9.82194 -3.00914 lowerback 7.86573 1.57272 6.3571
"""

from array import array
from dataclasses import dataclass

import numpy as np

from app.adapters.captures.asf_amc.skeleton import Acclaim, Bone, turn
from app.adapters.captures.asf_amc.words import Line, Lines, number
from app.adapters.captures.capture import CaptureError, Limits
from app.science.rig import BoolArray
from app.science.rotations import FloatArray, conjugate, identity, multiply


@dataclass(frozen=True)
class Rows:
    """The rows of an AMC file.

    They are the values (N, channels) of each moving bone, and whether each frame had its line (N,).
    """

    values: dict[str, FloatArray]
    present: dict[str, BoolArray]
    degrees: bool
    frames: int


def read_amc(data: bytes, skeleton: Acclaim, limits: Limits) -> Rows:
    """Parse the rows of an AMC file; a bone without a line in a frame keeps its previous values.

    Raises:
        CaptureError: a bone is unknown or its values do not match its dof; the error names the
            line.
    """
    moving = {b.name: b for b in (skeleton.root, *skeleton.bones.values()) if b.channels}
    # A frame is stored as one quaternion for each bone, moving or not.
    width = max(sum(len(b.channels) for b in moving.values()), 4 * (len(skeleton.bones) + 1))
    values = {name: array("d") for name in moving}
    present = {name: bytearray() for name in moving}
    degrees, frame, first = skeleton.degrees, 0, 0
    for line in iter(Lines(data).next, None):
        word = line.words[0]
        if word.startswith(":"):
            degrees = {":degrees": True, ":radians": False}.get(word.lower(), degrees)
        elif len(line.words) == 1 and word.isascii() and word.isdigit():
            first = int(word[:9]) if frame == 0 else first
            _check_number(line, first + frame)
            _begin_frame(values, present, moving)
            frame += 1
            if frame * width > limits.values:
                raise CaptureError(
                    f"{frame} frames of {width} values are too many.", line=line.number
                )
        else:
            _bone_row(line, moving, values, present, frame)
    if frame == 0:
        raise CaptureError("there is no frame: expected a line with the number 1.")
    return Rows(
        {name: np.array(v).reshape(frame, -1) for name, v in values.items()},
        {name: np.frombuffer(bytes(t), np.uint8).astype(np.bool_) for name, t in present.items()},
        degrees,
        frame,
    )


def _check_number(line: Line, expected: int) -> None:
    word = line.words[0]
    if len(word) > 9 or int(word) != expected:
        raise CaptureError(
            f"frame {word[:20]} follows frame {expected - 1}: one is missing or repeated.",
            line=line.number,
        )


def _begin_frame(
    values: dict[str, "array[float]"], present: dict[str, bytearray], moving: dict[str, Bone]
) -> None:
    for name, bone in moving.items():
        count = len(bone.channels)
        values[name].extend(values[name][-count:] or array("d", [0.0] * count))
        present[name].append(0)


def _bone_row(
    line: Line,
    moving: dict[str, Bone],
    values: dict[str, "array[float]"],
    present: dict[str, bytearray],
    frame: int,
) -> None:
    name, *words = line.words
    bone = moving.get(name)
    if bone is None:
        raise CaptureError(
            f"{name[:40]!r} does not move in the ASF: is this the skeleton of another person or"
            f" system? It moves {', '.join(list(moving)[:40])}.",
            line=line.number,
        )
    if frame == 0:
        raise CaptureError("there is a row before the first frame number.", line=line.number)
    count = len(bone.channels)
    if len(words) != count:
        raise CaptureError(
            f"{len(words)} values for {name!r}, its dof needs {count}.", line=line.number
        )
    for place in range(count):
        values[name][place - count] = number(line, place + 1, "a value")
    present[name][-1] = 1


def rotations_of(skeleton: Acclaim, rows: Rows) -> tuple[FloatArray, BoolArray]:
    """Return rotations (N, J, 4), and whether each was in the file.

    They are parent_from_joint = C M C^-1.
    """
    order = skeleton.order()
    rotations = identity(rows.frames, len(order))
    observed: BoolArray = np.ones((rows.frames, len(order)), np.bool_)
    for joint, name in enumerate(order):
        bone = skeleton.root if joint == 0 else skeleton.bones[name]
        turns = [place for place, channel in enumerate(bone.channels) if channel[0] == "R"]
        if not turns:
            continue
        letters = "".join(bone.channels[place][1] for place in turns)
        moved = turn(letters, rows.values[name][:, turns], degrees=rows.degrees, line=0)
        rotations[:, joint] = multiply(multiply(bone.axis, moved), conjugate(bone.axis))
        observed[:, joint] = rows.present[name]
    return rotations, observed


def root_positions(skeleton: Acclaim, rows: Rows) -> FloatArray:
    """Return the positions of the root (N, 3) in the file's unit."""
    columns = [skeleton.root.channels.index(axis) for axis in ("TX", "TY", "TZ")]
    places: FloatArray = rows.values["root"][:, columns] + np.array(skeleton.position)
    return places
