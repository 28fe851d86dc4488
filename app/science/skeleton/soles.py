"""Correct the pitch of a capture's feet so that standing feet are flat, and find the floor.

Captures disagree by up to 20 degrees about the pitch of a standing foot, as their markers were
placed differently on the shoe. A foot stands when its ankle is lowest, and is then flat. So each
foot, and its toes, is rotated by one constant pitch that makes it flat in those frames. The height
of the floor is that of the lower standing foot. A sole is the underside of the physics body's foot
and toes; where it is lowest, it may be deeper than that floor (see `clearance`).
"""

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray, from_rotation_vector, multiply, rotate
from app.science.skeleton.joints import JOINT_INDEX
from app.science.skeleton.model import Skeleton

HALF_FOOT_BREADTH, TOES_JOINT_HEIGHT = 0.0275, 0.014
"""In statures: half the breadth of a foot (Winter 2009, figure 4.1), and the height of the toe
joint above the sole (our estimate)."""
# In statures: a quarter of the foot's length, our estimate.
_HEEL_BEHIND_ANKLE = 0.25 * 0.152
_STANDING_SHARE = 0.1
# Beyond this angle the frames show no flat foot (as in dancing on the toes); nothing is corrected.
_LARGEST_CORRECTION_RAD = np.radians(25.0)


def flat_soles(world: FloatArray, skeleton: Skeleton, root_m: FloatArray) -> FloatArray:
    """Return world_from_joint rotations (N, 22, 4) with feet and toes flat where they stand.

    Args:
        world: (N, 22, 4) rotations world_from_joint.
        skeleton: gives the pitch of a flat foot, from ankle to toes.
        root_m: (N, 3) hips, whose height above the floor needs to be known only up to a constant.
    """
    result = world.copy()
    for side in ("Left", "Right"):
        standing = _lowest_frames(_ankle_height(world, skeleton, root_m, side))
        for part in ("Foot", "Toes"):
            joint = JOINT_INDEX[f"{side}{part}"]
            bone = skeleton.ends_m[joint]
            pitch = float(np.median(_pitch(rotate(world[standing, joint], bone))))
            correction = float(_pitch(bone)) - pitch
            if abs(correction) <= _LARGEST_CORRECTION_RAD:
                turn = from_rotation_vector(np.array((correction, 0.0, 0.0)))
                result[:, joint] = multiply(world[:, joint], turn)
    return result


def ground_height(world: FloatArray, skeleton: Skeleton, root_m: FloatArray) -> float:
    """Return the height of the floor under the capture's lower foot when it stands flat.

    The lowest point of all would be a toe in the swing phase, which a rigid model places too low.
    See `flat_soles`.
    """
    heights = [_ankle_height(world, skeleton, root_m, side) for side in ("Left", "Right")]
    ankle = min(float(np.median(height[_lowest_frames(height)])) for height in heights)
    return ankle - skeleton.ankle_height_m


def sole_height(world: FloatArray, skeleton: Skeleton, root_m: FloatArray) -> FloatArray:
    """Return the height (N,) of the lowest corner of both feet's soles."""
    lowest = np.full(len(root_m), np.inf)
    for side in ("Left", "Right"):
        foot, toes = JOINT_INDEX[f"{side}Foot"], JOINT_INDEX[f"{side}Toes"]
        ankle = _ankle_height(world, skeleton, root_m, side)
        ball = ankle + rotate(world[:, foot], skeleton.offsets_m[toes])[:, 1]
        stature = skeleton.stature_m
        half, heel = HALF_FOOT_BREADTH * stature, _HEEL_BEHIND_ANKLE * stature
        for joint, height, sole, ends in (
            (foot, ankle, skeleton.ankle_height_m, (skeleton.ends_m[foot, 2], heel)),
            (toes, ball, TOES_JOINT_HEIGHT * stature, (skeleton.ends_m[toes, 2], 0.0)),
        ):
            for x in (-half, half):
                for z in ends:
                    corner = rotate(world[:, joint], np.array((x, -sole, z)))
                    lowest = np.minimum(lowest, height + corner[:, 1])
    return lowest


def _ankle_height(
    world: FloatArray, skeleton: Skeleton, root_m: FloatArray, side: str
) -> FloatArray:
    height = root_m[:, 1].copy()
    outer = world[:, 0]
    for part in ("UpperLeg", "LowerLeg", "Foot"):
        joint = JOINT_INDEX[f"{side}{part}"]
        height += rotate(outer, skeleton.offsets_m[joint])[:, 1]
        outer = world[:, joint]
    return height


def _lowest_frames(height: FloatArray) -> npt.NDArray[np.intp]:
    count = max(1, round(_STANDING_SHARE * len(height)))
    return np.argsort(height)[:count]


def _pitch(direction: FloatArray) -> FloatArray:
    return np.asarray(np.arcsin(direction[..., 1] / np.linalg.norm(direction, axis=-1)))
