"""Precompute the parts of a transfer that are the same in every frame.

With T the T-pose and F the rotation from the avatar's facing to the source's, an avatar's joint is
in the world

    D_j F world_from_avatar_j(T) = world_from_source_j(t) C_j,
    C_j = world_from_source_j(T)^-1 F world_from_avatar_j(T):

the source's rotation times a constant, which is the only product per joint and frame.
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
    """The source or the avatar of a transfer, as arrays.

    Attributes:
        parents: (J,) index of each joint's parent, -1 for the root.
        offsets_m: (J, 3) position in the parent's frame.
        order: joints whose rotation in the world is needed, parents first.
        to_hips: the joints from the hips up to the one below the root; empty if the hips are the
            root.
    """

    parents: IntArray
    offsets_m: FloatArray
    order: IntArray
    to_hips: IntArray


class Plan(NamedTuple):
    """Two bodies and their connection, packed into few arrays.

    Each array argument adds a tenth of a microsecond to a call.

    Attributes:
        joints: (7, W) padded with -1: parents, order and path to the hips of the source, the same
            of the avatar, and the source joint that moves each avatar joint (-1 for none).
        numbers: (4, W, 4): offsets of source and avatar (three columns), right factors of the
            avatar's joints, and the scale in [3, 0, 0].
    """

    joints: IntArray
    numbers: FloatArray


def plan_of(
    source: Body, avatar: Body, moved_by: IntArray, factors: FloatArray, scale: float
) -> Plan:
    """Pack two bodies, and the source joint and the factor of each avatar joint, into a `Plan`."""
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
    """Return the constant right factor of each avatar joint, (A, 4).

    It is world_from_source(T)^-1 F world_from_avatar(T), with T the T-pose and F the rotation from
    the avatar's facing to the source's. For a joint that no source joint moves, it is the T-pose's
    local rotation.
    """
    factors = np.array(avatar.local_rotations, dtype=np.float64)
    turn = multiply(source.facing, conjugate(avatar.facing))
    for joint, mover in enumerate(moved_by):
        if mover >= 0:
            facing_alike = multiply(turn, avatar.world_rotations[joint])
            factors[joint] = multiply(conjugate(source.world_rotations[mover]), facing_alike)
    return normalise(factors)


def body_of(rig: Rig, needed: Iterable[int], hips: int) -> Body:
    """Return a rig as arrays for the kernel, with the needed joints and their ancestors."""
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
