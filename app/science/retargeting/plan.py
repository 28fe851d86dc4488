"""What of a transfer stays the same in every frame, worked out once.

With F the turn from the avatar's facing to the source's, an avatar's joint is in the world

    D_j F world_from_avatar_j(T) = world_from_source_j(t) C_j,
    C_j = world_from_source_j(T)^-1 F world_from_avatar_j(T):

the source's rotation times a constant, which is all that a frame has to multiply.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from app.science.retargeting.t_pose import TPose
from app.science.rig import Rig
from app.science.rotations import FloatArray, conjugate, multiply, normalise

IntArray = npt.NDArray[np.int64]


class Body(NamedTuple):
    """One side of a transfer.

    Attributes:
        parents: (J,) index of each joint's parent, -1 for the root.
        offsets_m: (J, 3) place in the parent's frame.
        order: joints whose rotation in the world is needed, parents first.
        to_hips: the joints from the hips up to the one below the root; empty if the hips are it.
    """

    parents: IntArray
    offsets_m: FloatArray
    order: IntArray
    to_hips: IntArray


class Plan(NamedTuple):
    """Two bodies and what connects them, in few arrays: each costs a call a tenth of a microsecond.

    Attributes:
        joints: (7, W) filled up with -1: parents, order and way to the hips of the source, the same
            of the avatar, and the source joint that moves each avatar joint (-1 for none).
        numbers: (4, W, 4): offsets of source and avatar (three columns), right factors of the
            avatar's joints, and the scale in [3, 0, 0].
    """

    joints: IntArray
    numbers: FloatArray


def plan_of(
    source: Body, avatar: Body, moved_by: IntArray, factors: FloatArray, scale: float
) -> Plan:
    """Pack two bodies, and each avatar joint's mover and factor."""
    width = max(len(source.parents), len(avatar.parents)) + 1
    joints = np.full((7, width), -1, dtype=np.int64)
    numbers = np.zeros((4, width, 4))
    rows = (
        source.parents,
        source.order,
        source.to_hips,
        avatar.parents,
        avatar.order,
        avatar.to_hips,
        moved_by,
    )
    for row, values in enumerate(rows):
        joints[row, : len(values)] = values
    numbers[0, : len(source.parents), :3] = source.offsets_m
    numbers[1, : len(avatar.parents), :3] = avatar.offsets_m
    numbers[2, : len(avatar.parents)] = factors
    numbers[3, 0, 0] = scale
    return Plan(joints, numbers)


def constant_factors(source: TPose, avatar: TPose, moved_by: IntArray) -> FloatArray:
    """Return world_from_source(T)^-1 F world_from_avatar(T), F from the avatar's facing to theirs.

    Where no joint moves it: the T-pose's local rotation.
    """
    factors = np.array(avatar.local_rotations, dtype=np.float64)
    turn = multiply(source.facing, conjugate(avatar.facing))
    for joint, mover in enumerate(moved_by):
        if mover >= 0:
            facing_alike = multiply(turn, avatar.world_rotations[joint])
            factors[joint] = multiply(conjugate(source.world_rotations[mover]), facing_alike)
    return normalise(factors)


def body_of(rig: Rig, needed: Iterable[int], hips: int) -> Body:
    """Return a rig as the kernel wants it, with what is above the joints that are needed."""
    order: set[int] = set()
    for joint in (*needed, hips):
        at = joint
        while at >= 0 and at not in order:
            order.add(at)
            at = rig.parents[at]
    to_hips = []
    while hips > 0:
        to_hips.append(hips)
        hips = rig.parents[hips]
    return Body(
        np.array(rig.parents, dtype=np.int64),
        np.array(rig.offsets_m, dtype=np.float64, order="C"),
        np.array(sorted(order), dtype=np.int64),
        np.array(to_hips, dtype=np.int64),
    )
