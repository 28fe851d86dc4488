"""Move the avatar's hips with the participant's: in straight lines, or immediately after a jump.

Plain floats, since this runs at every frame and NumPy is much slower for arrays of three or four
numbers; the poses of a frame's steps are computed in one compiled call.
"""

from math import acos, dist, isfinite, pi, sqrt
from typing import TYPE_CHECKING

from app.science.avatar.mjcf import HingeTable, SimulationError
from app.science.rotations import FloatArray, Quaternion, Vector

if TYPE_CHECKING:
    import mujoco

TELEPORT_M = 0.3
TELEPORT_RAD = pi / 3
_UNIT_TOLERANCE = 1e-3
_Pose = tuple[Vector, Quaternion]


class HipsPath:
    """The current and the next pose of the hips, (3,) and (4,) wxyz in the world."""

    def __init__(self, data: "mujoco.MjData", table: HingeTable) -> None:
        from app.science.avatar.simulation import frame_kernels  # loads the compiler

        self._kernels = frame_kernels
        self._data, self._table = data, table
        self._position = data.mocap_pos[table.mocap]
        self._rotation = data.mocap_quat[table.mocap]
        self._previous = self._next = _pose(self._position, self._rotation) or _ORIGIN
        self.teleports = 0

    def go_to(self, position_m: FloatArray, rotation: FloatArray) -> bool:
        """Set the pose to reach by the next frame; return False if it is invalid.

        Hips that would move too far are teleported there immediately.
        """
        pose = _pose(position_m, rotation)
        if pose is None:
            return False
        if (
            dist(pose[0], self._previous[0]) > TELEPORT_M
            or _angle_between(pose, self._previous) > TELEPORT_RAD
        ):
            self._jump_to(pose)
        else:
            self._next = pose
        return True

    def teleport(self, position_m: FloatArray, rotation: FloatArray) -> None:
        """Put the hips into a pose immediately and at rest; raises SimulationError."""
        pose = _pose(position_m, rotation)
        if pose is None:
            raise SimulationError(f"The hips cannot be at {position_m}, turned by {rotation}.")
        self._jump_to(pose)

    def way(self, steps: int) -> FloatArray | None:
        """Return the poses (steps, 7) at the ends of a frame's steps, None if the hips stay."""
        if self._previous == self._next:
            return None
        return self._kernels.hips_way(self._previous, self._next, steps)

    def put(self, pose: FloatArray) -> None:
        """Put the hips into one of these poses."""
        self._position[:] = pose[:3]
        self._rotation[:] = pose[3:]

    def arrive(self) -> None:
        """Put the hips into this frame's pose, from which they go on."""
        if self._previous == self._next:
            return
        self._previous = self._next
        self._position[:], self._rotation[:] = self._next

    def put_root(self) -> None:
        """Move welded hips to the pose of the body that they are welded to, at rest."""
        angles, speeds = self._table.root_angles, self._table.root_speeds
        if angles is not None and speeds is not None:
            self._data.qpos[angles : angles + 3] = self._previous[0]
            self._data.qpos[angles + 3 : angles + 7] = self._previous[1]
            self._data.qvel[speeds : speeds + 6] = 0.0

    def _jump_to(self, pose: _Pose) -> None:
        self.teleports += 1
        self._previous = self._next = pose
        self._position[:], self._rotation[:] = pose
        self.put_root()


_ORIGIN: _Pose = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))


def _pose(position_m: FloatArray, rotation: FloatArray) -> _Pose | None:
    """Return the pose with a unit quaternion; None if it is not finite or not nearly unit."""
    x, y, z = position_m.tolist()
    qw, qx, qy, qz = rotation.tolist()
    length = sqrt(qw * qw + qx * qx + qy * qy + qz * qz)
    # Comparisons with NaN are false.
    if not (isfinite(x) and isfinite(y) and isfinite(z) and abs(length - 1.0) <= _UNIT_TOLERANCE):
        return None
    return (x, y, z), (qw / length, qx / length, qy / length, qz / length)


def _angle_between(a: _Pose, b: _Pose) -> float:
    (aw, ax, ay, az), (bw, bx, by, bz) = a[1], b[1]
    dot = abs(aw * bw + ax * bx + ay * by + az * bz)
    return 2.0 * acos(min(dot, 1.0))
