"""A performer's movement on a body of another stature, over flat or uneven ground.

The rule for the ground is that of `Retargeter.batch`: in the standing frame the lower foot is on
the ground, and from then on the hips rise and fall with the ground below them.
"""

from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

import numpy as np

from app.features.movement.performers.assembly import BodyFrame
from app.features.movement.performers.performer import Agreed
from app.science.retargeting import (
    REFERENCE_JOINT_MAP,
    Flat,
    Ground,
    JointMap,
    Ramp,
    Retargeter,
    Steps,
    named_avatar,
    named_stature_m,
)
from app.science.rig import Rig, to_world
from app.science.rotations import FloatArray

GroundKey = Literal["flat", "ramp", "kerb", "steps"]
AHEAD_M = 0.8
"""Uneven ground begins so far in front of where the performer stood."""
RAMP_M = (4.0, 0.4)
"""Length and rise of the ramp: 10 %."""
KERB_M = 0.12
STEPS = 4
STEP_M = (0.29, 0.17)
"""Depth and rise of a step of stairs."""


@dataclass(frozen=True, eq=False, slots=True)
class Body:
    """A body that performers can move: any rig with its joint map.

    `stature_m` is that of a reference avatar, which the bodies of the lab can be drawn on; None for
    the skeleton of a capture.
    """

    rig: Rig
    joint_map: JointMap
    stature_m: float | None


def reference_body(name: str) -> Body:
    """Return the body of a stature, such as "165cm"; raises AvatarError if there is none."""
    return Body(named_avatar(name), REFERENCE_JOINT_MAP, named_stature_m(name))


@dataclass(frozen=True)
class GroundLine:
    """The profile of uneven ground, as it is drawn.

    `start_m` (x, z) is where it begins to differ from the floor, `uphill` (x, z) the unit vector of
    the direction in which it rises; `profile_m` are corners (distance from the start, height), the
    last of which continues.
    """

    start_m: tuple[float, float]
    uphill: tuple[float, float]
    profile_m: tuple[tuple[float, float], ...]


class OnBody:
    """Moves one body as one performer moves; its state is scratch memory, so for one thread.

    Making it loads compiled code for half a second, the first time in a process.

    Attributes:
        stood_m, faced: where the body stood in the standing frame, and the unit vector of the
            direction in which it faced, both (x, z).
    """

    def __init__(self, agreed: Agreed, joint_map: JointMap, body: Body, ground: GroundKey) -> None:
        """Prepare the transfer; raises RigError if a map does not match its skeleton."""
        self.agreed, self.body = agreed, body
        self._retargeter = Retargeter(agreed.rig, joint_map, body.rig, body.joint_map)
        self.scale = self._retargeter.scale
        self.unmapped = self._retargeter.unmapped_avatar_joints
        standing = agreed.standing
        root, local = self._retargeter.frame(standing.root_m, standing.rotations)
        self.stood_m, self.faced = _stance(body, root, local)
        self.line = _line(ground, self.stood_m, self.faced)
        self.ground: Ground = _ground(ground, self.line)
        self._is_flat = self.line is None
        self._offset_m = self._retargeter.hips_offset_m(
            standing.root_m, standing.rotations, self.ground
        )
        self._standing_m = self._height_m(root, local)

    def values(self, frame: BodyFrame) -> FloatArray:
        """Return the place of the body's hips and its local rotations, (3 + 4 A,)."""
        root, local = self._retargeter.frame(frame.root_m, frame.rotations, self._offset_m)
        if not self._is_flat:
            root[1] += self._height_m(root, local) - self._standing_m
        return np.concatenate((root, local.ravel()))

    def _height_m(self, root: FloatArray, local: FloatArray) -> float:
        hips = self._retargeter.hips_m(root, local)
        return float(self.ground.height_m(hips[0], hips[2]))


def _stance(
    body: Body, root: FloatArray, local: FloatArray
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return where a body is on the floor, and where it faces, both (x, z)."""
    places, _ = to_world(body.rig, root, local)
    across = np.zeros(3)
    for part in ("UpperLeg", "UpperArm"):
        sides = [body.joint_map.get(f"{side}{part}") for side in ("Left", "Right")]
        left, right = (None if one is None else places[body.rig.index(one)] for one in sides)
        if left is not None and right is not None:
            across = right - left
            break
    ahead = np.array((across[2], -across[0]))  # y x across
    length = float(np.linalg.norm(ahead))
    x, z = (float(one) for one in ahead / length) if length > 1e-6 else (0.0, -1.0)
    return (float(places[0][0]), float(places[0][2])), (x, z)


def _line(
    ground: GroundKey, place_m: tuple[float, float], ahead: tuple[float, float]
) -> GroundLine | None:
    if ground == "flat":
        return None
    start_m = (place_m[0] + AHEAD_M * ahead[0], place_m[1] + AHEAD_M * ahead[1])
    return GroundLine(start_m, ahead, _PROFILES_M[ground])


def _ground(ground: GroundKey, line: GroundLine | None) -> Ground:
    if line is None:
        return Flat()
    if ground == "ramp":
        return Ramp(line.start_m, line.uphill, *RAMP_M)
    rise_m, count = (KERB_M, 1) if ground == "kerb" else (STEP_M[1], STEPS)
    edges_m = tuple(STEP_M[0] * at for at in range(count))
    return Steps(line.start_m, line.uphill, edges_m, (rise_m,) * count)


def _stairs(rise_m: float, count: int) -> tuple[tuple[float, float], ...]:
    corners = [(STEP_M[0] * at, rise_m * (at + above)) for at in range(count) for above in (0, 1)]
    return tuple(corners)


_PROFILES_M = MappingProxyType(
    {
        "ramp": ((0.0, 0.0), RAMP_M),
        "kerb": _stairs(KERB_M, 1),
        "steps": _stairs(STEP_M[1], STEPS),
    }
)
