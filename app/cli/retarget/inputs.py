"""What `reembody retarget` reads: a clip, an avatar, and joint maps for them."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from app.adapters.captures.capture import Capture, CaptureError, Reading
from app.adapters.captures.files import read_capture_file
from app.science.retargeting import (
    REFERENCE_JOINT_MAP,
    JointMap,
    named_avatar,
    named_stature_m,
    propose_joint_map,
)
from app.science.rig import Rig, RigMotion

_LONGEST_MAP = 200_000
_UPS: dict[str, Literal["x", "y", "z"]] = {"x": "x", "y": "y", "z": "z"}


@dataclass(frozen=True, eq=False)
class Clip:
    """A capture as a skeleton's movement, and how it was read.

    Attributes:
        capture: as the file says.
        motion: its skeleton's, or that of the one fitted to its markers or bodies.
        notes: what a reader should know, each a sentence.
    """

    capture: Capture
    motion: RigMotion
    notes: tuple[str, ...]


def read_clip(path: Path, reading: Reading) -> Clip:
    """Read a capture, and fit a skeleton where it holds none.

    Raises:
        ValueError: the file cannot be used, with line and reason.
        OSError: it cannot be opened.
    """
    try:
        capture = read_capture_file(path, reading=reading)
    except CaptureError as error:
        raise ValueError(f"{path}: {error}") from error
    if isinstance(capture.motion, RigMotion):
        return Clip(capture, capture.motion, capture.notes)
    from app.science.fitting import FitError, fit_skeleton  # only markers need it

    try:
        fitted = fit_skeleton(capture.motion)
    except FitError as error:
        raise ValueError(f"{path}: {error}") from error
    return Clip(capture, fitted.motion, (*capture.notes, *fitted.notes))


def read_avatar(key: str) -> tuple[Rig, JointMap]:
    """The avatar a key or a file names, and its joint map.

    Raises:
        ValueError: neither a stature nor a file with a skeleton.
        OSError: the file cannot be opened.
    """
    path = Path(key)
    if named_stature_m(key) is not None or not path.exists():
        return named_avatar_or_file(key), REFERENCE_JOINT_MAP
    rig = read_clip(path, Reading()).motion.rig
    return rig, propose_joint_map(rig).joint_map


def named_avatar_or_file(key: str) -> Rig:
    """The reference avatar of this key; raises ValueError that also tells of files."""
    try:
        return named_avatar(key)
    except ValueError as error:
        raise ValueError(f"{error} A file with a skeleton is taken too, if it exists.") from error


def reading_of(skeleton: Path | None, unit: float | None, up: str | None) -> Reading:
    """What the options say about the clip.

    Raises:
        ValueError: the axis is none of x, y and z.
        OSError: the skeleton cannot be opened.
    """
    if up is not None and up.lower() not in _UPS:
        raise ValueError(f"--up {up!r}: x, y and z are valid")
    return Reading(
        metres_per_unit=unit,
        up=None if up is None else _UPS[up.lower()],
        companions={} if skeleton is None else {skeleton.name: skeleton.read_bytes()},
    )


def joint_map_of(rig: Rig, path: Path | None) -> JointMap:
    """The joint map in a file, body joint to the clip's joint, or the one the names propose.

    Raises:
        ValueError: the file is no object of names.
        OSError: it cannot be opened.
    """
    if path is None:
        return propose_joint_map(rig).joint_map
    if path.stat().st_size > _LONGEST_MAP:
        raise ValueError(f"{path}: {_LONGEST_MAP} bytes are the most a joint map may have")
    try:
        told: object = json.loads(path.read_text(encoding="utf-8-sig"))
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{path}: no JSON ({error})") from error
    if not isinstance(told, Mapping) or not all(isinstance(name, str) for name in told.values()):
        raise ValueError(
            f'{path}: a joint map is one object, body joint to joint of the clip, as {{"Hips":'
            ' "pelvis"}'
        )
    return {str(joint): str(name) for joint, name in told.items()}
