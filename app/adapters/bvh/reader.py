"""From a BVH text to a `BvhClip`.

BVH names no units, so the caller must: the CMU captures use 0.056444 m a unit, most others cm.
A joint's rotation channels turn about its moving axes in the order they are listed, and that order
may differ from joint to joint.
"""

import math
from pathlib import Path

import numpy as np

from app.adapters.bvh.clip import BvhClip, BvhError, BvhLimits
from app.adapters.bvh.hierarchy import Hierarchy, read_hierarchy, read_number
from app.science.rotations import FloatArray, from_euler, identity

_DEFAULT_LIMITS = BvhLimits()


def read_bvh(path: Path, *, metres_per_unit: float, limits: BvhLimits = _DEFAULT_LIMITS) -> BvhClip:
    """Read a file; see `parse_bvh`.

    Raises:
        BvhError: also where the file is too large or no text.
        OSError: the file cannot be opened.
    """
    if path.stat().st_size > limits.characters:
        raise BvhError(0, f"the file is larger than {limits.characters} bytes.")
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise BvhError(0, "the file is not UTF-8 text.") from None
    return parse_bvh(text, metres_per_unit=metres_per_unit, limits=limits)


def parse_bvh(text: str, *, metres_per_unit: float, limits: BvhLimits = _DEFAULT_LIMITS) -> BvhClip:
    """Read a BVH text.

    Args:
        text: the file's content; line ends of any system, a byte order mark is skipped.
        metres_per_unit: length of the file's unit.
        limits: what is refused as too large.

    Raises:
        BvhError: the line and the reason, for anything that does not follow the format: also
            non-finite numbers, a row with too few or many values, and a number of rows other than
            the declared one.
    """
    if not (math.isfinite(metres_per_unit) and metres_per_unit > 0.0):
        raise BvhError(0, f"metres_per_unit is {metres_per_unit}, it must be above zero.")
    if len(text) > limits.characters:
        raise BvhError(0, f"the text is longer than {limits.characters} characters.")
    lines = text.removeprefix("\ufeff").splitlines()
    tree = read_hierarchy(lines, limits)
    first_row, frame_count, frame_time_s = _read_motion_head(lines, tree.motion_line)
    values = _read_rows(lines, first_row, frame_count, tree, limits)
    translations, rotations = _to_poses(tree, values, metres_per_unit)
    return BvhClip(
        names=tuple(tree.names),
        parents=tuple(tree.parents),
        offsets_m=np.array(tree.offsets) * metres_per_unit,
        end_sites=tuple(
            (joint, (x * metres_per_unit, y * metres_per_unit, z * metres_per_unit))
            for joint, (x, y, z) in tree.end_sites
        ),
        channels=tuple(tree.channels),
        frame_time_s=frame_time_s,
        translations_m=translations,
        rotations=rotations,
    )


def _read_motion_head(lines: list[str], motion_line: int) -> tuple[int, int, float]:
    """Return the line number of the first row, the declared frames and the frame time."""
    filled = [n for n in range(motion_line, len(lines)) if lines[n].strip()][:2]
    if len(filled) < 2:
        raise BvhError(len(lines), "the text ends before 'Frames:' and 'Frame Time:'.")
    frames_line, time_line = filled
    frames = _after(lines[frames_line], "frames:", frames_line + 1)
    if not frames.isdecimal() or int(frames) == 0:
        raise BvhError(frames_line + 1, f"{frames!r} frames: a whole number above zero is valid.")
    word = _after(lines[time_line], "frame time:", time_line + 1)
    frame_time_s = read_number(word, time_line + 1, "the frame time in seconds")
    if frame_time_s <= 0.0:
        raise BvhError(time_line + 1, f"frame time {word}: it must be above zero seconds.")
    return time_line + 2, int(frames), frame_time_s


def _after(line: str, label: str, number: int) -> str:
    words = " ".join(line.split())
    if not words.lower().startswith(label):
        raise BvhError(number, f"expected {label!r} and a value, got {words[:60]!r}.")
    return words[len(label) :].strip()


def _read_rows(
    lines: list[str], first_row: int, declared: int, tree: Hierarchy, limits: BvhLimits
) -> FloatArray:
    width = sum(len(channels) for channels in tree.channels)
    if width == 0:
        raise BvhError(tree.motion_line, "no joint has a channel, so there is no motion to read.")
    if declared * width > limits.values:
        raise BvhError(first_row - 2, f"{declared} frames of {width} values are too many.")
    rows, numbers = [], []
    for number, line in enumerate(lines[first_row - 1 :], first_row):
        words = line.split()
        if not words:
            continue
        if len(words) != width:
            raise BvhError(number, f"{len(words)} values in this row, the channels need {width}.")
        rows.append(words)
        numbers.append(number)
    if len(rows) != declared:
        raise BvhError(
            len(lines), f"{len(rows)} rows of motion, but 'Frames:' declares {declared}."
        )
    return _to_numbers(rows, numbers)


def _to_numbers(rows: list[list[str]], numbers: list[int]) -> FloatArray:
    try:
        values = np.array(rows, dtype=np.float64)
    except ValueError:
        values = np.full((1, 1), np.nan)
    if not np.isfinite(values).all():
        # Only now is it worth going word by word, to say where.
        for number, words in zip(numbers, rows, strict=True):
            for word in words:
                read_number(word, number, "a motion value")
    return values


def _to_poses(
    tree: Hierarchy, values: FloatArray, metres_per_unit: float
) -> tuple[FloatArray, FloatArray]:
    frames, joints = values.shape[0], len(tree.names)
    translations = np.tile(np.array(tree.offsets), (frames, 1, 1))
    rotations = identity(frames, joints)
    column = 0
    for joint, channels in enumerate(tree.channels):
        turning, order = [], ""
        for channel in channels:
            if channel.endswith("position"):
                translations[:, joint, "XYZ".index(channel[0])] = values[:, column]
            else:
                turning.append(column)
                order += channel[0]
            column += 1
        if order:
            rotations[:, joint] = from_euler(order, np.radians(values[:, turning]))
    return translations * metres_per_unit, rotations
