"""Convert a capture to the movement of the product's body on a floor, in place or travelling.

A session takes many minutes and a captured walk a few seconds. A walk that is to accompany a
session is therefore retargeted to the participant's skeleton, and its slow travel and slow turning
are removed: it becomes walking on the spot, facing -z, with standing feet flat on the floor.
`skeleton.loop` then makes it endless. Legs that a capture does not contain are straight beneath the
hips.

To follow a person's own path, `movement_travelling` leaves travel and turning as they are. There
the floor of a capture drifts, and a physics body whose feet are to be under the floor is held up
by them and bends elsewhere, so the body is also raised smoothly where a sole would sink.
"""

import numpy as np

from app.science.retargeting.joint_map import JointMap
from app.science.retargeting.reference_avatars import REFERENCE_JOINT_MAP, reference_avatar
from app.science.retargeting.transfer import Retargeter
from app.science.rig import RigMotion, to_local, to_world
from app.science.rotations import FloatArray, from_rotation_vector, identity, multiply, rotate
from app.science.skeleton import (
    JOINT_INDEX,
    Movement,
    Skeleton,
    SkeletonError,
    clearance_m,
    continuous,
    flat_soles,
    ground_height,
    sole_height,
)

# Longer than a stride, shorter than a turn of the walk.
_PATH_SMOOTHING_S = 0.6
_LEGS = tuple(
    f"{side}{part}"
    for side in ("Left", "Right")
    for part in ("UpperLeg", "LowerLeg", "Foot", "Toes")
)


def movement_in_place(source: RigMotion, joint_map: JointMap, skeleton: Skeleton) -> Movement:
    """Retarget a capture to a skeleton, moving in place and facing -z.

    The hips' height and sway are scaled by the ratio of leg lengths. Slow travel and slow turning
    (over 0.6 s) are removed; a standing foot is flat on the floor.

    Raises:
        JointMapError: the map does not match the capture's skeleton.
        SkeletonError: the capture has fewer than two frames.
    """
    return _movement(source, joint_map, skeleton, in_place=True)


def movement_travelling(source: RigMotion, joint_map: JointMap, skeleton: Skeleton) -> Movement:
    """Retarget a capture to a skeleton with the person's own travel and turning, on the floor.

    A standing foot is flat, and no sole is under the floor.

    It raises the same errors as `movement_in_place`.
    """
    return _movement(source, joint_map, skeleton, in_place=False)


def _movement(
    source: RigMotion, joint_map: JointMap, skeleton: Skeleton, *, in_place: bool
) -> Movement:
    if source.frame_count < 2:
        raise SkeletonError(
            "A capture of one frame contains no movement: give at least two frames."
        )
    avatar = reference_avatar(skeleton.stature_m)
    retargeter = Retargeter(source.rig, joint_map, avatar, REFERENCE_JOINT_MAP)
    moved = retargeter.batch(source)
    root = moved.root_positions_m.copy()
    _, world = to_world(avatar, root, moved.rotations)
    if in_place:
        world, root = _in_place(world, root, _PATH_SMOOTHING_S * source.rate_hz)
    if not set(_LEGS) & set(retargeter.carried):
        world, root = _standing(world, root, skeleton)
    world = flat_soles(world, skeleton, root)
    root[:, 1] -= ground_height(world, skeleton, root)
    if not in_place:
        root[:, 1] += clearance_m(sole_height(world, skeleton, root), source.rate_hz)
    return Movement(source.rate_hz, root, continuous(to_local(avatar, world)))


def _standing(
    world: FloatArray, root: FloatArray, skeleton: Skeleton
) -> tuple[FloatArray, FloatArray]:
    """Straighten the legs, which the capture lacks, and put the lower foot on the floor."""
    world, root = world.copy(), root.copy()
    world[:, [JOINT_INDEX[name] for name in _LEGS]] = identity(1)
    sockets = [JOINT_INDEX["LeftUpperLeg"], JOINT_INDEX["RightUpperLeg"]]
    below = rotate(world[:, :1], skeleton.offsets_m[sockets])[..., 1].min(axis=1)
    root[:, 1] = skeleton.ankle_height_m + skeleton.leg_length_m - below
    return world, root


def _in_place(
    world: FloatArray, root: FloatArray, smoothing: float
) -> tuple[FloatArray, FloatArray]:
    """Remove slow turning and slow travel from a movement; `smoothing` is in frames."""
    forward = rotate(world[:, 0], np.array((0.0, 0.0, -1.0)))
    heading = np.unwrap(np.arctan2(-forward[:, 0], -forward[:, 2]))
    back = _yaw(-_slow(heading, smoothing))
    sway = root - np.stack(
        (_slow(root[:, 0], smoothing), np.zeros(len(root)), _slow(root[:, 2], smoothing)), axis=-1
    )
    return multiply(back[:, np.newaxis], world), rotate(back, sway)


def _yaw(angle_rad: FloatArray) -> FloatArray:
    return from_rotation_vector(np.stack((0 * angle_rad, angle_rad, 0 * angle_rad), axis=-1))


def _slow(values: FloatArray, smoothing: float) -> FloatArray:
    """Return the slow part of values: their linear trend plus the smoothed remainder."""
    from scipy.ndimage import gaussian_filter1d  # slow to import; a server seldom needs it

    frames = np.arange(len(values))
    line = np.polyval(np.polyfit(frames, values, 1), frames)
    rest = gaussian_filter1d(values - line, smoothing, mode="nearest")
    return np.asarray(line + rest, dtype=np.float64)
