"""How the avatar's hips follow the participant's: in straight lines, and at once when they jump.

Plain floats: this runs at every step, and arrays of three or four numbers are slower by far.
"""

from math import acos, dist, isfinite, pi, sqrt
from typing import TYPE_CHECKING

from app.science.avatar.mjcf import HingeTable, SimulationError
from app.science.rotations import FloatArray, Quaternion, Vector, q_blend

if TYPE_CHECKING:
    import mujoco

TELEPORT_M = 0.3
TELEPORT_RAD = pi / 3
_UNIT_TOLERANCE = 1e-3
_Place = tuple[Vector, Quaternion]


class HipsPath:
    """The hips' place, (3,) and (4,) wxyz in the world: where they are, and where they go next."""

    def __init__(self, data: "mujoco.MjData", table: HingeTable) -> None:
        self._data, self._table = data, table
        self._position = data.mocap_pos[table.mocap]
        self._rotation = data.mocap_quat[table.mocap]
        self._from = self._to = _place(self._position, self._rotation) or _ORIGIN
        self.teleports = 0

    def go_to(self, position_m: FloatArray, rotation: FloatArray) -> bool:
        """Go there until the next frame, or at once where it is far; False if it is no place."""
        place = _place(position_m, rotation)
        if place is None:
            return False
        if dist(place[0], self._from[0]) > TELEPORT_M or _turned(place, self._from) > TELEPORT_RAD:
            self._be_at(place)
        else:
            self._to = place
        return True

    def teleport(self, position_m: FloatArray, rotation: FloatArray) -> None:
        """Be there at once and at rest; raises SimulationError."""
        place = _place(position_m, rotation)
        if place is None:
            raise SimulationError(f"The hips cannot be at {position_m}, turned by {rotation}.")
        self._be_at(place)

    def go(self, fraction: float) -> None:
        """Be on the way: 0 where the last frame ended, 1 where this one ends."""
        if self._from == self._to:
            return
        if fraction >= 1.0:
            self._from = self._to
            self._position[:], self._rotation[:] = self._to
            return
        (x, y, z), turn = self._from
        (to_x, to_y, to_z), turned = self._to
        self._position[0] = x + fraction * (to_x - x)
        self._position[1] = y + fraction * (to_y - y)
        self._position[2] = z + fraction * (to_z - z)
        self._rotation[:] = q_blend(turn, turned, fraction)

    def put_root(self) -> None:
        """Put welded hips where the body is that they are welded to, at rest."""
        angles, speeds = self._table.root_angles, self._table.root_speeds
        if angles is not None and speeds is not None:
            self._data.qpos[angles : angles + 3] = self._from[0]
            self._data.qpos[angles + 3 : angles + 7] = self._from[1]
            self._data.qvel[speeds : speeds + 6] = 0.0

    def _be_at(self, place: _Place) -> None:
        self.teleports += 1
        self._from = self._to = place
        self._position[:], self._rotation[:] = place
        self.put_root()


_ORIGIN: _Place = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))


def _place(position_m: FloatArray, rotation: FloatArray) -> _Place | None:
    """The place with a rotation of unit length; None where a value is not finite, or no turn."""
    x, y, z = position_m.tolist()
    qw, qx, qy, qz = rotation.tolist()
    length = sqrt(qw * qw + qx * qx + qy * qy + qz * qz)
    # A comparison with NaN is false.
    if not (isfinite(x) and isfinite(y) and isfinite(z) and abs(length - 1.0) <= _UNIT_TOLERANCE):
        return None
    return (x, y, z), (qw / length, qx / length, qy / length, qz / length)


def _turned(a: _Place, b: _Place) -> float:
    along = abs(sum(p * q for p, q in zip(a[1], b[1], strict=True)))
    return 2.0 * acos(min(along, 1.0))
