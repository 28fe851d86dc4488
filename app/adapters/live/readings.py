"""What a packet of tracking data says, in our units, and the limits that it must keep.

All positions are in metres and all rotations are unit quaternions w, x, y, z. The world has y up
and is right-handed, like that of captures; the source decides where its origin is. A decoder never
raises: what it cannot use is counted in `Reading.problems`.
"""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal, Protocol

Kind = Literal["tracker", "rigid_body", "bone", "root", "headset", "controller"]
Problem = Literal["malformed", "arguments", "number", "limit", "version", "unused"]
"""Why something in a packet was not used.

`malformed`: the structure cannot be read. `arguments`: a known message or field has the wrong
arguments. `number`: a position or rotation is not a finite, plausible number. `limit`: too long,
too many or too deep. `version`: this version of the protocol is not known or not read. `unused`:
well-formed, but not about trackers (facial expressions, buttons, cameras); not a mistake.
"""
Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]

MAX_POSES = 512
"""The most poses that are used of one packet."""
MAX_NAME = 64
"""The most characters in the name of a tracker or source."""
MAX_DISTANCE_M = 10_000.0
"""Positions further from the origin than this are refused: no tracking space is as large."""
NORM_TOLERANCE = 0.1
"""How far the norm of a rotation may be from 1; rounding takes 0.001, an unset rotation is 0."""


class Refused(Exception):
    """Something in a packet cannot be used; internal to the decoders, which count it."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        self.problem = problem


@dataclass(frozen=True, slots=True)
class Pose:
    """Where a tracked thing is, in the world; a bone of a skeleton, in its parent if sent so.

    `position_m` or `rotation` is None if the packet contains only the other one. `tracked` is False
    if the source says that it lost the thing, so that the pose is old or guessed.
    """

    tracker: str
    kind: Kind
    position_m: Vector | None
    rotation: Quaternion | None
    tracked: bool = True


@dataclass(frozen=True, slots=True)
class BoneDefinition:
    """A bone of a skeleton, by its tracker's name, and its parent; None for the root.

    `offset_m` is where the bone is in its parent's frame, zero for the root. It is None if the
    definition does not tell; the bone's poses are then in the parent's frame and have it.
    """

    tracker: str
    parent: str | None
    offset_m: Vector | None


@dataclass(frozen=True)
class SkeletonDefinition:
    """Which trackers of a source are the bones of one body: parents first, the root at the head.

    `in_parent`: whether poses of bones are in their parent's frame; None if the source does not
    tell. The root's pose is in the world in any case. At rest no bone is rotated.
    """

    name: str
    bones: tuple[BoneDefinition, ...]
    in_parent: bool | None


@dataclass(frozen=True)
class Reading:
    """What one packet says.

    `source` is the name by which the source introduces itself, empty if it does not. `time_s` is by
    the source's own clock, and `frame` its own counter; None where the protocol has none.
    `skeletons` are those to which bones among the poses belong, as far as the source has told.
    """

    poses: tuple[Pose, ...] = ()
    source: str = ""
    time_s: float | None = None
    frame: int | None = None
    problems: Counter[Problem] = field(default_factory=Counter)
    skeletons: tuple[SkeletonDefinition, ...] = ()


class Decoder(Protocol):
    """Reads the packets of one source, and may keep what they say about each other."""

    def read(self, packet: bytes) -> Reading:
        """Return what a packet says; never raises."""


def checked_name(name: object) -> str:
    """Return a printable name without surrounding spaces; raise Refused if it cannot be shown."""
    if not isinstance(name, str):
        raise Refused("arguments")
    name = name.strip()
    if len(name) > MAX_NAME:
        raise Refused("limit")
    if not name or not name.isprintable():
        raise Refused("arguments")
    return name


def checked_position(numbers: Sequence[float]) -> Vector:
    """Return x, y, z in metres; raise Refused if one is not finite or implausibly far away."""
    x, y, z = numbers
    most = MAX_DISTANCE_M
    if not (-most <= x <= most and -most <= y <= most and -most <= z <= most):  # also for NaN
        raise Refused("number")
    return (x, y, z)


def checked_rotation(w: float, x: float, y: float, z: float) -> Quaternion:
    """Return a rotation as it was sent; raise Refused if its norm is not about 1."""
    if not abs(math.hypot(w, x, y, z) - 1) <= NORM_TOLERANCE:  # catches NaN as well
        raise Refused("number")
    return (w, x, y, z)


def checked_time(time_s: float) -> float:
    """Return a time in seconds; raise Refused if it is not finite or cannot be subtracted."""
    if not abs(time_s) <= 1e12:
        raise Refused("number")
    return time_s
