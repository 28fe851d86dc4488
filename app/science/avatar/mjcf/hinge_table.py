"""Find the indices of an avatar's hinges, motors and bodies in a MuJoCo model."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import AXIS_NAMES, FINGER_PARTS, PARENT_OF, PART_NAMES
from app.science.avatar.configuration import HIPS_TARGET
from app.science.skeleton import JOINT_NAMES, PARENTS


class SimulationError(ValueError):
    """A model is not an avatar or lacks a given name, or a given value or time is invalid."""


if TYPE_CHECKING:
    import mujoco

IndexArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class HingeTable:
    """Indices of an avatar's hinges and bodies in the arrays of its MuJoCo model.

    The n hinges are in the model's order.

    Attributes:
        names: the names of the axes with a hinge.
        columns: (n,) columns of these axes in `AXIS_NAMES`.
        joints: (n,) rows of `jnt_range`.
        angles: (n,) indices into `qpos`.
        speeds: (n,) indices into `qvel`.
        position_targets: (n,) indices into `ctrl`; each is followed by the speed's target.
        motors: (n,) rows of `actuator_force`.
        bodies: part -> body.
        joint_bodies: (22,) body that carries each joint of the skeleton; where the model lacks the
            joint's own part, the body of the part above it.
        parent_bodies: (22,) the body that carries each joint's parent; the world's, 0, for the
            hips.
        finger_bodies: (30,) body of each finger part; where the model lacks it, that of the part
            above it.
        above_fingers: (30,) body of the part above each of them.
        mocap: row of the body whose pose is set: the hips themselves, or the body they are welded
            to.
        root_angles: first index of welded hips in `qpos`; None where the hips are carried.
        root_speeds: first index of welded hips in `qvel`; None where the hips are carried.
    """

    names: tuple[str, ...]
    columns: IndexArray
    joints: IndexArray
    angles: IndexArray
    speeds: IndexArray
    position_targets: IndexArray
    motors: IndexArray
    bodies: dict[str, int]
    joint_bodies: IndexArray
    parent_bodies: IndexArray
    finger_bodies: IndexArray
    above_fingers: IndexArray
    mocap: int
    root_angles: int | None
    root_speeds: int | None


def hinge_table(model: "mujoco.MjModel") -> HingeTable:
    """Return the hinge table; raise SimulationError if `build_mjcf` did not write the model."""
    joints = {model.jnt(row).name: row for row in range(model.njnt)}
    names = tuple(name for name in joints if name in AXIS_NAMES)
    bodies = {model.body(row).name: row for row in range(model.nbody)}
    parts = {part: bodies[part] for part in PART_NAMES if part in bodies}
    if "Hips" not in parts or model.nmocap != 1:
        raise SimulationError(
            "The model has no hips that can be positioned: build it with build_mjcf."
        )
    rows = np.array([joints[name] for name in names], dtype=np.int64)
    motors = np.array([model.actuator(name).id for name in names], dtype=np.int64)
    joint_bodies = _joint_bodies(parts)
    placed = bodies[HIPS_TARGET] if HIPS_TARGET in bodies else parts["Hips"]
    root = joints.get("Hips")
    return HingeTable(
        names=names,
        columns=np.array([AXIS_NAMES.index(name) for name in names], dtype=np.int64),
        joints=rows,
        angles=model.jnt_qposadr[rows].astype(np.int64),
        speeds=model.jnt_dofadr[rows].astype(np.int64),
        position_targets=model.actuator_ctrladr[motors].astype(np.int64),
        motors=motors,
        bodies=parts,
        joint_bodies=joint_bodies,
        parent_bodies=np.array([0 if above < 0 else joint_bodies[above] for above in PARENTS]),
        finger_bodies=np.array([_carrier(part, parts) for part in FINGER_PARTS]),
        above_fingers=np.array([_carrier(PARENT_OF[part], parts) for part in FINGER_PARTS]),
        mocap=int(model.body_mocapid[placed]),
        root_angles=None if root is None else int(model.jnt_qposadr[root]),
        root_speeds=None if root is None else int(model.jnt_dofadr[root]),
    )


def _carrier(part: str | None, parts: dict[str, int]) -> int:
    """Return the body of a part or, if the model lacks it, of the nearest part above it."""
    while part is not None and part not in parts:
        part = PARENT_OF[part]
    return 0 if part is None else parts[part]


def _joint_bodies(parts: dict[str, int]) -> IndexArray:
    carriers: list[int] = []
    for joint, above in zip(JOINT_NAMES, PARENTS, strict=True):
        carriers.append(parts[joint] if joint in parts else carriers[above])
    return np.array(carriers, dtype=np.int64)
