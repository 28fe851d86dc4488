"""Compute forward kinematics: from local rotations to positions in the world.

With q_j = parent_from_joint and o_j the joint's offset in its parent's frame, in order of joints:

    world_from_j = world_from_parent q_j
    p_j = p_parent + world_from_parent o_j,   p_0 = root position.
"""

from dataclasses import dataclass
from typing import cast

import numpy as np

from app.science.rotations import (
    FloatArray,
    Quaternion,
    Vector,
    multiply,
    q_multiply,
    q_rotate,
    rotate,
)
from app.science.skeleton.joints import JOINT_COUNT, PARENTS
from app.science.skeleton.model import Skeleton, SkeletonError


@dataclass(frozen=True, eq=False)
class Pose:
    """The pose of a body at one moment, as local rotations.

    Attributes:
        root_position_m: (3,) the hips in the world.
        rotations: (22, 4) unit quaternions wxyz, parent_from_joint; row 0 is world_from_hips.
    """

    root_position_m: FloatArray
    rotations: FloatArray


@dataclass(frozen=True, eq=False)
class WorldPose:
    """Poses of the joints in the world.

    Attributes:
        positions_m: (..., 22, 3) positions of the joints.
        rotations: (..., 22, 4) rotations world_from_joint.
    """

    positions_m: FloatArray
    rotations: FloatArray


@dataclass(frozen=True, eq=False)
class BodySegments:
    """Capsules of the 22 body parts in the world.

    Attributes:
        axes_m: (..., 22, 2, 3) start and end of each capsule's axis in the world; equal for a
            sphere.
        radii_m: (22,) radius of each capsule.
    """

    axes_m: FloatArray
    radii_m: FloatArray


def forward_kinematics(
    skeleton: Skeleton, root_positions_m: FloatArray, rotations: FloatArray
) -> WorldPose:
    """Compute the joints of one frame, (3,) and (22, 4), or of many, (N, 3) and (N, 22, 4).

    Raises:
        SkeletonError: the arrays' shapes do not fit together.
    """
    expected = (*root_positions_m.shape[:-1], JOINT_COUNT, 4)
    if root_positions_m.shape[-1:] != (3,) or rotations.shape != expected:
        raise SkeletonError(
            f"Root positions {root_positions_m.shape} and rotations {rotations.shape} do not fit:"
            " give (N, 3) with (N, 22, 4), or (3,) with (22, 4)."
        )
    if rotations.ndim == 2:
        return _one_frame(skeleton, root_positions_m, rotations)
    positions = np.empty((*rotations.shape[:-1], 3))
    world = np.empty_like(rotations)
    positions[..., 0, :], world[..., 0, :] = root_positions_m, rotations[..., 0, :]
    for joint in range(1, JOINT_COUNT):
        parent = world[..., PARENTS[joint], :]
        world[..., joint, :] = multiply(parent, rotations[..., joint, :])
        offset = rotate(parent, skeleton.offsets_m[joint])
        positions[..., joint, :] = positions[..., PARENTS[joint], :] + offset
    return WorldPose(positions, world)


def _one_frame(skeleton: Skeleton, root_position_m: FloatArray, rotations: FloatArray) -> WorldPose:
    # Plain floats make a single frame six times faster than arrays of 22 rows.
    local = cast("list[Quaternion]", rotations.tolist())
    offsets = cast("list[Vector]", skeleton.offsets_m.tolist())
    places = [cast("Vector", root_position_m.tolist())]
    turns = [local[0]]
    for joint in range(1, JOINT_COUNT):
        parent = PARENTS[joint]
        x, y, z = q_rotate(turns[parent], offsets[joint])
        px, py, pz = places[parent]
        places.append((px + x, py + y, pz + z))
        turns.append(q_multiply(turns[parent], local[joint]))
    return WorldPose(np.array(places), np.array(turns))


def body_part_segments(skeleton: Skeleton, world: WorldPose) -> BodySegments:
    """Return the capsule of each body part, for one frame or many."""
    ends = np.stack((skeleton.capsule_starts_m, skeleton.capsule_ends_m), axis=1)
    turned = rotate(world.rotations[..., np.newaxis, :], ends)
    return BodySegments(world.positions_m[..., np.newaxis, :] + turned, skeleton.radii_m)
