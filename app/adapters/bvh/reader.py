"""Parse a BVH text into a `BvhClip`.

BVH has no units, so the caller must specify them: the CMU captures use 0.056444 m per unit, most
others cm.

A joint's rotation channels rotate about its moving axes in the order in which they are listed, and
that order may differ from joint to joint.
"""

import math
from array import array
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np

from app.adapters.bvh.clip import BvhClip, BvhError, BvhLimits
from app.adapters.bvh.hierarchy import Hierarchy, read_hierarchy, read_number
from app.science.rotations import FloatArray, from_euler, identity

_DEFAULT_LIMITS = BvhLimits()


def read_bvh(path: Path, *, metres_per_unit: float, limits: BvhLimits = _DEFAULT_LIMITS) -> BvhClip:
    """Read a BVH file; see `parse_bvh`.

    Raises:
        BvhError: as for `parse_bvh`, and if the file is too large or not text.
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
    """Parse a BVH text.

    Args:
        text: the file's content, with any line endings; a byte order mark is skipped.
        metres_per_unit: length of the file's unit.
        limits: the largest sizes that are accepted.

    Raises:
        BvhError: the line and the reason, if the text does not follow the format; also for
            non-finite numbers, a row with too few or too many values, and a number of rows other
            than the declared one.
    """
    if len(text) > limits.characters:
        raise BvhError(0, f"the text is longer than {limits.characters} characters.")
    lines = text.removeprefix("\ufeff").splitlines()
    return parse_bvh_lines(lines, metres_per_unit=metres_per_unit, limits=limits)


def parse_bvh_lines(
    lines: Iterable[str], *, metres_per_unit: float, limits: BvhLimits = _DEFAULT_LIMITS
) -> BvhClip:
    """Parse a BVH text line by line, so that a long one need not fit in memory.

    Raises the same errors as `parse_bvh`.
    """
    if not (math.isfinite(metres_per_unit) and metres_per_unit > 0.0):
        raise BvhError(0, f"metres_per_unit is {metres_per_unit}, it must be above zero.")
    numbered = enumerate(lines, 1)
    tree = read_hierarchy(numbered, limits)
    declared, frame_time_s = _read_motion_head(numbered)
    values = _read_rows(numbered, declared, tree, limits)
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


@dataclass(frozen=True)
class _Declared:
    """The number of frames that a file declares, and the line of the declaration."""

    frames: int
    line: int


def _read_motion_head(lines: Iterator[tuple[int, str]]) -> tuple[_Declared, float]:
    """Return the declared number of frames, and the frame time in seconds."""
    filled = list(islice(((number, line) for number, line in lines if line.strip()), 2))
    if len(filled) < 2:
        raise BvhError(0, "the text ends before 'Frames:' and 'Frame Time:'.")
    (frames_line, frames_text), (time_line, time_text) = filled
    frames = _after(frames_text, "frames:", frames_line)
    if not (frames.isascii() and frames.isdecimal() and 0 < len(frames) < 16) or int(frames) == 0:
        raise BvhError(frames_line, f"{frames[:40]!r} frames: a whole number above zero is valid.")
    word = _after(time_text, "frame time:", time_line)
    frame_time_s = read_number(word, time_line, "the frame time in seconds")
    if frame_time_s <= 0.0:
        raise BvhError(time_line, f"frame time {word}: it must be above zero seconds.")
    return _Declared(int(frames), frames_line), frame_time_s


def _after(line: str, label: str, number: int) -> str:
    words = " ".join(line.split())
    if not words.lower().startswith(label):
        raise BvhError(number, f"expected {label!r} and a value, got {words[:60]!r}.")
    return words[len(label) :].strip()


def _read_rows(
    lines: Iterator[tuple[int, str]], declared: _Declared, tree: Hierarchy, limits: BvhLimits
) -> FloatArray:
    width = sum(len(channels) for channels in tree.channels)
    if width == 0:
        raise BvhError(declared.line, "no joint has a channel, so there is no motion to read.")
    # A pose takes seven numbers per joint, however few channels the joint has.
    needed = declared.frames * max(width, 7 * len(tree.names))
    if needed > limits.values:
        problem = f"{declared.frames} frames of {len(tree.names)} joints are too many."
        raise BvhError(declared.line, problem)
    values, number, found = array("d"), 0, 0
    for number, line in lines:
        words = line.split()
        if not words:
            continue
        if len(words) != width:
            raise BvhError(number, f"{len(words)} values in this row, the channels need {width}.")
        if found == declared.frames:
            raise BvhError(
                number, f"a row more than the number that 'Frames:' declares {declared.frames}."
            )
        values.extend(_numbers(words, number))
        found += 1
    if found != declared.frames:
        raise BvhError(number, f"{found} rows of motion, but 'Frames:' declares {declared.frames}.")
    return np.frombuffer(values, dtype=np.float64).reshape(found, width)


def _numbers(words: list[str], number: int) -> list[float]:
    try:
        values = list(map(float, words))
    except ValueError:
        values = [math.nan]
    if not math.isfinite(sum(values)):
        # Parse word by word only now, to find the invalid one.
        values = [read_number(word, number, "a motion value") for word in words]
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
