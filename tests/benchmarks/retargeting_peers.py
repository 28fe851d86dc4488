"""Do the same retargeting with other libraries' rotations: SciPy and PyMotion.

Each computes only what a retargeter computes: rotations of the source in the world, the constant
factor of each joint, back to local. Results are compared before anything is timed.
"""

from dataclasses import dataclass

import numpy as np
from pymotion.ops import skeleton_np as pymotion_skeleton
from pymotion.rotations import quat_np as pymotion_quat
from scipy.spatial.transform import Rotation

from app.science.rotations import FloatArray


@dataclass(frozen=True, eq=False)
class Task:
    """The retargeting to compute for every frame.

    Attributes:
        source_parents, avatar_parents: the trees of joints, as parent indices.
        source_offsets_m: (S, 3), needed by PyMotion's kinematics.
        moved_by: source joint of each avatar joint, -1 for none.
        factors: (A, 4) right factors; local rotations for joints that no source joint moves.
    """

    source_parents: tuple[int, ...]
    avatar_parents: tuple[int, ...]
    source_offsets_m: FloatArray
    moved_by: tuple[int, ...]
    factors: FloatArray


def by_scipy(task: Task, rotations: FloatArray) -> FloatArray:
    """Retarget with SciPy, a Rotation object per joint: one frame, (S, 4), or all, (N, S, 4)."""
    locals_ = [
        Rotation.from_quat(rotations[..., joint, :], scalar_first=True)
        for joint in range(len(task.source_parents))
    ]
    factors = [Rotation.from_quat(factor, scalar_first=True) for factor in task.factors]
    source: list[Rotation] = []
    for parent, local in zip(task.source_parents, locals_, strict=True):
        source.append(local if parent < 0 else source[parent] * local)
    avatar: list[Rotation] = []
    result = np.empty((*rotations.shape[:-2], len(task.avatar_parents), 4))
    for joint, (parent, mover) in enumerate(zip(task.avatar_parents, task.moved_by, strict=True)):
        outer = source[mover] if mover >= 0 else avatar[parent]
        avatar.append(outer * factors[joint])
        local = avatar[joint] if parent < 0 else avatar[parent].inv() * avatar[joint]
        result[..., joint, :] = local.as_quat(scalar_first=True)
    return result


def by_scipy_frame_by_frame(task: Task, rotations: FloatArray) -> FloatArray:
    """Retarget one frame at a time with SciPy, as would be done live."""
    return np.stack([by_scipy(task, frame) for frame in rotations])


def by_pymotion(task: Task, rotations: FloatArray) -> FloatArray:
    """Retarget all frames together with PyMotion's forward kinematics, products and inverse."""
    roots = np.zeros((*rotations.shape[:-2], 3))
    parents = np.array(task.source_parents)
    _, source = pymotion_skeleton.fk_quat(rotations, roots, task.source_offsets_m, parents)
    moved = [joint for joint, mover in enumerate(task.moved_by) if mover >= 0]
    movers = [task.moved_by[joint] for joint in moved]
    world = np.empty((*rotations.shape[:-2], len(task.avatar_parents), 4))
    world[..., moved, :] = pymotion_quat.mul(source[..., movers, :], task.factors[moved])
    for joint, mover in enumerate(task.moved_by):
        if mover < 0:
            outer = world[..., task.avatar_parents[joint], :]
            world[..., joint, :] = pymotion_quat.mul(outer, task.factors[joint])
    local = pymotion_skeleton.from_global_rotations(world, np.array(task.avatar_parents))
    return np.asarray(local)
