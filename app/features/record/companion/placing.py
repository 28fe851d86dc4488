"""Where a companion stands in the participant's room, and a performer's pose brought there.

The participant stands at the origin and faces -z, towards the mirror and the boxes. A companion
stands beside the way to both, faces the participant, and does not come nearer: whoever walks away
from where they stood goes on the spot.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from app.features.movement.performers import BodyFrame, OnBody
from app.science.rotations import FloatArray, from_rotation_vector, multiply
from app.science.tasks import TaskLayout

Place = Literal["ahead_left", "ahead_right", "left", "right"]
MIRROR_HALF_M = 0.9
"""Half the width of the mirror, on the wall ahead (frontend/src/vr/world/mirror.ts)."""
STRAYS_M = 0.35
"""The hips of a companion stay within this distance of their place."""
HIGHEST_HIPS_M = 2.5
"""The hips of a companion stay between the floor and this height, whatever their source sends."""
HALF_BODY_M = 0.3
"""From the hips to the side of a person with hanging arms, with some room."""
_SIDES = MappingProxyType({"ahead_left": -1.0, "left": -1.0, "ahead_right": 1.0, "right": 1.0})
_AHEAD_M = MappingProxyType({"ahead_left": 0.9, "ahead_right": 0.9, "left": 0.0, "right": 0.0})
"""The nearest mirror is 1.6 m ahead, so that nobody reaches through its wall."""


@dataclass(frozen=True)
class Standing:
    """A place on the floor: x and z in metres, and where one faces there.

    `heading_rad` is about the vertical axis: 0 towards -z, positive to the left.
    """

    position_m: tuple[float, float]
    heading_rad: float


def standing_at(place: Place, layouts: Iterable[TaskLayout]) -> Standing:
    """Return where a companion stands who leaves the mirror and these boxes free."""
    reach_m = [MIRROR_HALF_M]
    for layout in layouts:
        reach_m += [abs(one.center_m[0]) + one.half_size_m[0] for one in layout.surfaces]
    x = _SIDES[place] * (max(reach_m) + STRAYS_M + HALF_BODY_M)
    z = -_AHEAD_M[place]
    # Towards the participant, who stands at the origin.
    return Standing((x, z), heading_of((-x, -z)))


def heading_of(direction: tuple[float, float]) -> float:
    """Return the heading of a direction (x, z) on the floor, rad."""
    x, z = direction
    return math.atan2(-x, -z)


class InRoom:
    """Brings the poses of one body to one place in the room."""

    def __init__(self, body: OnBody, standing: Standing) -> None:
        self.body = body
        self._place_m = np.array(standing.position_m)
        self._stood_m = np.array(body.stood_m)
        turn_rad = standing.heading_rad - heading_of(body.faced)
        self._turn = from_rotation_vector(np.array((0.0, turn_rad, 0.0)))
        cos, sin = math.cos(turn_rad), math.sin(turn_rad)
        self._on_floor = np.array(((cos, sin), (-sin, cos)))
        """Turns (x, z) as the rotation about the vertical axis does."""

    def values(self, frame: BodyFrame) -> NDArray[np.float32]:
        """Return the place of the hips in the room (m) and the joints' local rotations, (3 + 4 A,).

        The frame must be of the skeleton that the body follows.
        """
        values: FloatArray = self.body.values(frame)
        away_m = self._on_floor @ (values[[0, 2]] - self._stood_m)
        distance_m = float(np.linalg.norm(away_m))
        if distance_m > STRAYS_M:
            away_m *= STRAYS_M / distance_m
        values[[0, 2]] = self._place_m + away_m
        values[1] = min(max(values[1], 0.0), HIGHEST_HIPS_M)
        values[3:7] = multiply(self._turn, values[3:7])
        return values.astype(np.float32)
