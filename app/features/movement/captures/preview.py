"""Encode positions for a preview as bytes that a page can draw without parsing every number.

  bytes 0-3    length L of the header, unsigned, little-endian
  bytes 4-     header: JSON in UTF-8, padded with spaces so that 4 + L is a multiple of 4
  then         float32, little-endian: x, y, z in metres of every point of every frame,
               [frame][point][axis]; y is up, the world right-handed; NaN where nothing was seen
  then         only for avatars, on request: float32, w, x, y, z of every joint's rotation in its
               parent's frame, [frame][joint][wxyz]; the header then has `rotations`: true

The header has `kind` ("skeleton", "markers" or "bodies"), `names` and `parents` of the J points
(-1 for no parent), `frames` N, `rate_hz` of these frames, `recorded_rate_hz`, and `start_s`, the
time from the recording's first frame to these.

Frames are left out to stay below `MAX_HZ` and `MAX_NUMBERS`: rate_hz = recorded_rate_hz / step.
"""

import json
import math
import struct
from dataclasses import dataclass

import numpy as np

from app.science.rig import BodyMotion, MarkerMotion, RigMotion
from app.science.rotations import FloatArray

MAX_HZ = 60.0
MAX_NUMBERS = 4_000_000
"""16 MB: six minutes of sixty points at sixty hertz."""
GAP_STEPS = 3.0
"""A logger's samples have a gap between them if they are more usual steps apart than this."""


@dataclass(frozen=True, eq=False)
class Points:
    """Positions (N, J, 3) in metres at a constant rate, starting `start_s` into the recording.

    `parents` are indices as in a rig, -1 for none. `rotations`: (N, J, 4) parent_from_joint of the
    joints of an avatar, whose T-pose is not rotated; None if they were not requested.
    """

    kind: str
    names: tuple[str, ...]
    parents: tuple[int, ...]
    rate_hz: float
    positions_m: FloatArray
    start_s: float = 0.0
    rotations: FloatArray | None = None


def points_of(motion: RigMotion | MarkerMotion | BodyMotion) -> Points:
    """Return the points of a recorded movement."""
    if isinstance(motion, RigMotion):
        return skeleton_points(motion)
    alone = (-1,) * len(motion.names)
    if isinstance(motion, MarkerMotion):
        return Points("markers", motion.names, alone, motion.rate_hz, motion.positions_m)
    rate_hz, positions_m = _evenly(motion)
    return Points("bodies", motion.names, alone, rate_hz, positions_m)


def skeleton_points(motion: RigMotion, *, start_s: float = 0.0) -> Points:
    """Return the joint positions of a skeleton's movement."""
    positions_m, _ = motion.world()
    positions_m[~motion.observed] = np.nan
    rig = motion.rig
    return Points("skeleton", rig.names, rig.parents, motion.rate_hz, positions_m, start_s)


def encode(points: Points) -> bytes:
    """Return the points in the binary form of this module."""
    numbers = 3 if points.rotations is None else 7
    step = step_for(points.positions_m.shape[0], points.rate_hz, numbers * len(points.names))
    kept = np.ascontiguousarray(points.positions_m[::step], dtype="<f4")
    turns = b""
    if points.rotations is not None:
        turns = np.ascontiguousarray(points.rotations[::step], dtype="<f4").tobytes()
    header = json.dumps(
        {
            "kind": points.kind,
            "names": points.names,
            "parents": points.parents,
            "frames": kept.shape[0],
            "rate_hz": points.rate_hz / step,
            "recorded_rate_hz": points.rate_hz,
            "start_s": points.start_s,
            **({"rotations": True} if turns else {}),
        }
    ).encode()
    header += b" " * (-len(header) % 4)
    return struct.pack("<I", len(header)) + header + kept.tobytes() + turns


def step_for(
    frames: int, rate_hz: float, numbers_a_frame: int, max_numbers: int = MAX_NUMBERS
) -> int:
    """Return n so that keeping every nth frame stays below `MAX_HZ` and `max_numbers`."""
    for_rate = math.ceil(rate_hz / MAX_HZ - 1e-6)
    return max(1, for_rate, math.ceil(frames * numbers_a_frame / max_numbers))


def _evenly(motion: BodyMotion) -> tuple[float, FloatArray]:
    """Resample to a constant rate with the nearest samples, because loggers sample unevenly."""
    rate_hz = min(motion.rate_hz, MAX_HZ)
    if motion.frame_count < 2 or rate_hz <= 0.0:
        return 1.0, motion.positions_m
    moments = 1 + math.floor((motion.times_s[-1] - motion.times_s[0]) * rate_hz + 1e-6)
    # A gap of hours in a log must not become hours of frames.
    moments = min(moments, max(1, MAX_NUMBERS // (3 * len(motion.names))))
    at_s = motion.times_s[0] + np.arange(moments) / rate_hz
    after = np.clip(np.searchsorted(motion.times_s, at_s), 1, motion.frame_count - 1)
    nearer_before = at_s - motion.times_s[after - 1] <= motion.times_s[after] - at_s
    nearest = np.where(nearer_before, after - 1, after)
    positions_m = motion.positions_m[nearest]
    far = np.abs(motion.times_s[nearest] - at_s) > GAP_STEPS / 2.0 / rate_hz
    positions_m[far] = np.nan
    return rate_hz, positions_m
