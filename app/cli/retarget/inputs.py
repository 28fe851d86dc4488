"""Read the inputs of `reembody retarget`: a clip, an avatar, joint maps, and the ground.

The ground that the avatar walks on is one word on the command line:

    flat               level, the default
    kerb:H@D           a step of H metres after D metres of the path
    ramp:H/L@D         H metres up over L metres, starting after D metres of the path

Negative heights go down. The path is the straight line from the start to the end of the movement of
the avatar's hips.
"""

import json
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from app.adapters.captures import Capture, CaptureError, Reading, read_capture_file
from app.errors import missing_file
from app.science.anatomy import Notice
from app.science.retargeting import (
    REFERENCE_JOINT_MAP,
    Ground,
    JointMap,
    Ramp,
    Steps,
    check_joint_map,
    checked_skeleton,
    named_avatar,
    named_stature_m,
    propose_joint_map,
)
from app.science.rig import Rig, RigMotion
from app.science.rotations import FloatArray

_LONGEST_MAP = 200_000
_UPS: dict[str, Literal["x", "y", "z"]] = {"x": "x", "y": "y", "z": "z"}
_NUMBER = r"([+-]?\d{1,3}(?:\.\d{1,4})?)"
_KERB = re.compile(rf"kerb:{_NUMBER}@{_NUMBER}")
_RAMP = re.compile(rf"ramp:{_NUMBER}/{_NUMBER}@{_NUMBER}")
_GROUNDS = "flat, kerb:HEIGHT@DISTANCE and ramp:HEIGHT/LENGTH@DISTANCE are valid, all in metres"
GroundAlong = Callable[[FloatArray], Ground]


@dataclass(frozen=True, eq=False)
class Clip:
    """A capture as a skeleton's movement, and how it was read.

    Attributes:
        capture: as read from the file.
        motion: of the capture's skeleton, or of the one fitted to its markers or bodies.
        notes: what a user should know, each a sentence.
        notices: what anatomy does not allow, and whether it was mended.
        joint_map: body joint -> joint of the skeleton.
    """

    capture: Capture
    motion: RigMotion
    notes: tuple[str, ...]
    notices: tuple[Notice, ...]
    joint_map: JointMap


def read_clip(path: Path, reading: Reading, own_map: Path | None = None) -> Clip:
    """Read a capture, and fit a skeleton if it contains none.

    Args:
        path: the capture.
        reading: how to read it.
        own_map: JSON file with a joint map; None to propose one by joint names.

    Raises:
        ValueError: the file cannot be used, with line and reason.
        OSError: it cannot be opened.
    """
    try:
        capture = read_capture_file(path, reading=reading)
    except CaptureError as error:
        raise ValueError(f"{path}: {error}") from error
    if isinstance(capture.motion, RigMotion):
        rig = capture.motion.rig
        by_names = propose_joint_map(rig).joint_map
        joint_map = by_names if own_map is None else joint_map_of(rig, own_map)
        check_joint_map(rig, joint_map)
        motion, notices = checked_skeleton(capture.motion, joint_map, names_map=by_names)
        return Clip(capture, motion, capture.notes, (*capture.notices, *notices), joint_map)
    from app.science.fitting import FitError, fit_skeleton  # only needed for markers

    try:
        fitted = fit_skeleton(capture.motion)
    except FitError as error:
        raise ValueError(f"{path}: {error}") from error
    notes = (*capture.notes, *fitted.notes)
    joint_map = joint_map_of(fitted.motion.rig, own_map)
    return Clip(capture, fitted.motion, notes, (*capture.notices, *fitted.notices), joint_map)


@dataclass(frozen=True, eq=False)
class Avatar:
    """An avatar, its joint map (body joint -> joint of its rig), and what anatomy says of it."""

    rig: Rig
    joint_map: JointMap
    notices: tuple[Notice, ...] = ()


def read_avatar(key: str) -> Avatar:
    """Return the avatar that a key or a file names.

    Raises:
        ValueError: neither a stature nor a file with a skeleton.
        OSError: the file cannot be opened.
    """
    path = Path(key)
    if named_stature_m(key) is not None or not path.exists():
        return Avatar(named_avatar_or_file(key), REFERENCE_JOINT_MAP)
    clip = read_clip(path, Reading())
    told = tuple(replace(one, what=f"The avatar's file: {one.what}") for one in clip.notices)
    return Avatar(clip.motion.rig, clip.joint_map, told)


def named_avatar_or_file(key: str) -> Rig:
    """Return the reference avatar of this key; raise ValueError, which also mentions files."""
    try:
        return named_avatar(key)
    except ValueError as error:
        raise ValueError(
            f"{error} A file with a skeleton is valid, too, but {missing_file(Path(key))}."
        ) from error


def reading_of(skeleton: Path | None, unit: float | None, up: str | None) -> Reading:
    """Return the options of the command that say how to read the clip.

    Raises:
        ValueError: the axis is not x, y or z.
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
    """Read the joint map (body joint to clip joint) from a file, or propose one by joint names.

    Raises:
        ValueError: the file is not a JSON object of names.
        OSError: it cannot be opened.
    """
    if path is None:
        return propose_joint_map(rig).joint_map
    if path.stat().st_size > _LONGEST_MAP:
        raise ValueError(f"{path}: {_LONGEST_MAP} bytes are the most a joint map may have")
    try:
        content: object = json.loads(path.read_text(encoding="utf-8-sig"))
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{path}: not valid JSON ({error})") from error
    if not isinstance(content, Mapping) or not all(
        isinstance(name, str) for name in content.values()
    ):
        raise ValueError(
            f'{path}: a joint map is one object, body joint to joint of the clip, as {{"Hips":'
            ' "pelvis"}'
        )
    return {str(joint): str(name) for joint, name in content.items()}


def ground_along(word: str) -> GroundAlong | None:
    """Return a function from the positions of the hips (N, 3) to the ground; None for flat.

    Raises:
        ValueError: the word describes no ground. The returned function raises it, too, if the hips
            do not move, so that the ground has no direction.
    """
    if word == "flat":
        return None
    kerb, ramp = _KERB.fullmatch(word), _RAMP.fullmatch(word)
    if kerb is not None:
        height, distance = (float(number) for number in kerb.groups())
        return lambda hips_m: Steps(*_way(word, hips_m), (distance,), (height,))
    if ramp is not None and float(ramp[2]) > 0.0:
        return lambda hips_m: _ramp(word, hips_m, *(float(number) for number in ramp.groups()))
    raise ValueError(f"--ground {word!r}: {_GROUNDS}, such as kerb:0.12@1.5")


def _ramp(word: str, hips_m: FloatArray, height: float, length: float, distance: float) -> Ramp:
    (x, z), (along_x, along_z) = _way(word, hips_m)
    foot = (x + distance * along_x, z + distance * along_z)
    return Ramp(foot, (along_x, along_z), run_m=length, rise_m=height)


def _way(word: str, hips_m: FloatArray) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the start of the hips' path (x, z), and the unit direction to its end."""
    x, _, z = (hips_m[-1] - hips_m[0]).tolist()
    length = math.hypot(x, z)
    if length < 1e-3:
        raise ValueError(f"--ground {word}: the hips do not move, so only flat is possible")
    return (float(hips_m[0, 0]), float(hips_m[0, 2])), (x / length, z / length)
