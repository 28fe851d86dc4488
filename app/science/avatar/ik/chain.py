"""Prepare the avatar's model for inverse kinematics: hips that can be positioned, hinges, goals.

The hips are a mocap body or are attached to a free joint, as `mjcf.ModelOptions.hips` defines; in
both cases their pose is set here directly. A tracked part is moved only by the hinges between it
and the hips; fingers, feet and toes stay at rest.
"""

import mujoco
import numpy as np
import numpy.typing as npt

from app.science.avatar.ik.goals import GOAL_PARTS, IkError
from app.science.avatar.ik.hips import Trunk
from app.science.rotations import FloatArray

_HINGE, _FREE = int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_FREE)
_BODY = mujoco.mjtObj.mjOBJ_BODY


class Chain:
    """The avatar's model, prepared for inverse kinematics, with data separate from any simulation.

    Attributes:
        axis_names: every hinge, in the order of the model.
        low_rad, high_rad: the limits of the hinges, shape (axes,); infinite where there are none.
        moving: indices of the hinges that move a tracked part.
        moves: (goals, moving) whether each of these moves each goal; the hips' row is all false.
        trunk: lengths for estimating the hips.

    Raises:
        IkError: the model lacks a tracked part, or its hips are fixed.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self.model, self.data = model, mujoco.MjData(model)
        self._bodies = [_body(model, part) for part in GOAL_PARTS]
        hinges = [joint for joint in range(model.njnt) if model.jnt_type[joint] == _HINGE]
        self.axis_names = tuple(model.joint(joint).name for joint in hinges)
        self._at = model.jnt_qposadr[hinges]
        limited = model.jnt_range[hinges, 0] < model.jnt_range[hinges, 1]
        self.low_rad = np.where(limited, model.jnt_range[hinges, 0], -np.inf)
        self.high_rad = np.where(limited, model.jnt_range[hinges, 1], np.inf)
        ancestors_of_goals = [_ancestors(model, body) for body in self._bodies]
        moves = np.array(
            [
                [model.jnt_bodyid[joint] in ancestors for joint in hinges]
                for ancestors in ancestors_of_goals
            ]
        )
        self.moving = np.flatnonzero(moves.any(axis=0))
        self.moves: npt.NDArray[np.bool_] = moves[:, self.moving]
        self._columns = model.jnt_dofadr[hinges][self.moving]
        self._mocap, self._free = _root(model, self._bodies[0])
        self._jacobian = np.zeros((2, 3, model.nv))
        self.trunk = self._trunk()

    def place(self, hips_m: FloatArray, hips: FloatArray, angles_rad: FloatArray) -> None:
        """Set the pose: hips (3,) and (4,) in the world, every hinge's angle (axes,)."""
        data = self.data
        data.qpos[self._at] = angles_rad
        if self._free is None:
            data.mocap_pos[self._mocap], data.mocap_quat[self._mocap] = hips_m, hips
        else:
            data.qpos[self._free : self._free + 3] = hips_m
            data.qpos[self._free + 3 : self._free + 7] = hips
        mujoco.mj_kinematics(self.model, data)

    def prepare_jacobians(self) -> None:
        """Prepare the data that `jacobian` needs; call this after each `place`."""
        mujoco.mj_comPos(self.model, self.data)

    def position_m(self, goal: int) -> FloatArray:
        """Return the position of a tracked part's joint in the world, (3,)."""
        position: FloatArray = self.data.xpos[self._bodies[goal]]
        return position

    def rotation(self, goal: int) -> FloatArray:
        """Return a tracked part's orientation world_from_part, (4,) wxyz."""
        rotation: FloatArray = self.data.xquat[self._bodies[goal]]
        return rotation

    def jacobian(self, goal: int) -> FloatArray:
        """Return the Jacobian of a tracked part in the world, (6, moving).

        Its first three rows are linear, the others angular velocities.
        """
        linear, angular = self._jacobian
        mujoco.mj_jacBody(self.model, self.data, linear, angular, self._bodies[goal])
        result: FloatArray = self._jacobian.reshape(6, -1)[:, self._columns]
        return result

    def _trunk(self) -> Trunk:
        upright = np.array((1.0, 0.0, 0.0, 0.0))
        self.place(np.zeros(3), upright, np.zeros(len(self.axis_names)))
        sockets = [self.data.xpos[_body(self.model, f"{side}UpperLeg")] for side in _SIDES]
        left, right = (_length(self.position_m(4 + i) - sockets[i]) for i in range(2))
        return Trunk(
            hips_to_head_m=_length(self.position_m(1)),
            hips_to_sockets_m=-0.5 * float(sockets[0][1] + sockets[1][1]),
            half_breadth_m=0.5 * float(sockets[1][0] - sockets[0][0]),
            thigh_m=0.5 * (left + right),
        )


_SIDES = ("Left", "Right")


def _length(v: FloatArray) -> float:
    x, y, z = v.tolist()
    return float(np.sqrt(x * x + y * y + z * z))


def _body(model: mujoco.MjModel, part: str) -> int:
    result = int(mujoco.mj_name2id(model, _BODY, part))
    if result < 0:
        raise IkError(
            f"The model has no {part}: inverse kinematics needs {', '.join(GOAL_PARTS)} and the"
            " parts between them."
        )
    return result


def _ancestors(model: mujoco.MjModel, body: int) -> set[int]:
    ancestors: set[int] = set()
    while body > 0:
        ancestors.add(body)
        body = int(model.body_parentid[body])
    return ancestors


def _root(model: mujoco.MjModel, hips: int) -> tuple[int, int | None]:
    """Return the index of the hips' mocap body, and the address of their free joint or None."""
    mocap = int(model.body_mocapid[hips])
    for joint in range(model.njnt):
        if model.jnt_bodyid[joint] == hips and model.jnt_type[joint] == _FREE:
            return mocap, int(model.jnt_qposadr[joint])
    if mocap < 0:
        raise IkError("The model's Hips are fixed: they must be a mocap body or have a free joint.")
    return mocap, None
