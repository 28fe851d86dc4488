"""What `reembody retarget` reads: a clip, an avatar, joint maps for them, and the ground.

The ground an avatar is led over is one word on the command line:

    flat               level, which is usual
    kerb:H@D           a step of H metres after D metres of the way
    ramp:H/L@D         H metres up over L metres, beginning after D metres of the way

Heights below zero go down. The way is the straight line from where the avatar's hips begin to where
they end.
"""

import json
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from app.adapters.captures import Capture, CaptureError, Reading, read_capture_file
from app.errors import missing_file
from app.science.retargeting import (
    REFERENCE_JOINT_MAP,
    Ground,
    JointMap,
    Ramp,
    Steps,
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
        raise ValueError(
            f"{error} A file with a skeleton is taken too, but {missing_file(Path(key))}."
        ) from error


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


def ground_along(told: str) -> GroundAlong | None:
    """What makes the ground a word names, once the way of the hips (N, 3) is known; None for flat.

    Raises:
        ValueError: the word names no ground. What is returned raises it too, where hips that go
            nowhere give the ground no direction.
    """
    if told == "flat":
        return None
    kerb, ramp = _KERB.fullmatch(told), _RAMP.fullmatch(told)
    if kerb is not None:
        height, distance = (float(number) for number in kerb.groups())
        return lambda hips_m: Steps(*_way(told, hips_m), (distance,), (height,))
    if ramp is not None and float(ramp[2]) > 0.0:
        return lambda hips_m: _ramp(told, hips_m, *(float(number) for number in ramp.groups()))
    raise ValueError(f"--ground {told!r}: {_GROUNDS}, such as kerb:0.12@1.5")


def _ramp(told: str, hips_m: FloatArray, height: float, length: float, distance: float) -> Ramp:
    (x, z), (along_x, along_z) = _way(told, hips_m)
    foot = (x + distance * along_x, z + distance * along_z)
    return Ramp(foot, (along_x, along_z), run_m=length, rise_m=height)


def _way(told: str, hips_m: FloatArray) -> tuple[tuple[float, float], tuple[float, float]]:
    """Where the hips begin, (x, z), and the unit direction to where they end."""
    x, _, z = (hips_m[-1] - hips_m[0]).tolist()
    length = math.hypot(x, z)
    if length < 1e-3:
        raise ValueError(f"--ground {told}: this clip goes nowhere, so only flat is possible")
    return (float(hips_m[0, 0]), float(hips_m[0, 2])), (x / length, z / length)
