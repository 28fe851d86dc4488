"""From a capture of another skeleton to our joints.

The capture's rest pose is seldom our T-pose: CMU legs are splayed by 20 degrees, and its person
faces +z. With world_from_capture(t) the capture joint's rotation in its world, our joint takes

    world_from_joint(t) = world_from_capture(t) A_j,   A_j = swing(R o_j, c_j) R,

where R turns our T-pose to face the way the capture's rest pose faces, o_j is our bone's direction
in the T-pose and c_j the capture's in its rest pose. So our bone points where theirs points, by the
smallest turn. Hips, collar bones, head and toes take A_j = R: their bones start elsewhere than
ours or have no length, and their frames are upright in both rest poses.

Source: the global transfer Q_avatar = Q_capture Q_T of Degen et al. (2022), "Movement diversity".
"""

from collections.abc import Mapping
from typing import Protocol

import numpy as np

from app.science.rotations import (
    FloatArray,
    conjugate,
    from_rotation_vector,
    geodesic_angle,
    multiply,
    normalise,
    rotate,
    swing_between,
)
from app.science.skeleton.joint_map import CMU_JOINTS
from app.science.skeleton.joints import JOINT_COUNT, JOINT_INDEX, JOINT_NAMES, PARENTS
from app.science.skeleton.model import Skeleton, SkeletonError
from app.science.skeleton.movement import Movement, continuous
from app.science.skeleton.soles import flat_soles, ground_height

# The bone that is aligned, by its joint: the joint at its other end.
_BONE_TO = {
    "Spine": "Chest",
    "Chest": "UpperChest",
    "Neck": "Head",
    **{f"{s}{a}": f"{s}{b}" for s in ("Left", "Right") for a, b in (
        ("UpperArm", "LowerArm"), ("LowerArm", "Hand"),
        ("UpperLeg", "LowerLeg"), ("LowerLeg", "Foot"), ("Foot", "Toes"),
    )},
}  # fmt: skip
# Slower than a stride, faster than a turn of the walk.
_PATH_SMOOTHING_S = 0.6
_SHORTEST_BONE_M = 1e-3
# Thrown balls turn the shoulder at about 120 rad/s (Fleisig et al. 1995); walking stays below 20.
_FASTEST_JOINT_RAD_S = 120.0


class CaptureClip(Protocol):
    """What a capture must offer: J joints with a rest pose, N frames; see `adapters.bvh`."""

    @property
    def names(self) -> tuple[str, ...]:
        """Joint names, parents first."""

    @property
    def parents(self) -> tuple[int, ...]:
        """Index of each joint's parent, -1 for the root."""

    @property
    def offsets_m(self) -> FloatArray:
        """(J, 3) rest position in the parent's frame, y up."""

    @property
    def frame_time_s(self) -> float:
        """Time from frame to frame."""

    def world(self) -> tuple[FloatArray, FloatArray]:
        """Positions (N, J, 3) in metres and world_from_joint rotations (N, J, 4)."""


def retarget(
    clip: CaptureClip, skeleton: Skeleton, joint_map: Mapping[str, str] = CMU_JOINTS
) -> Movement:
    """Carry a capture over to a skeleton, walking in place and facing -z.

    A T-pose before the movement is left out. The hips' height and sway are scaled by the ratio of
    leg lengths; a standing foot is flat on the floor. Slow travel and slow turning (over 0.6 s) are
    taken out.

    Raises:
        SkeletonError: the capture lacks a mapped joint, has fewer than two frames or no legs.
    """
    source = _source_joints(clip, joint_map)
    positions, rotations = _without_rest_row(*clip.world(), clip.frame_time_s)
    rest = _rest_positions(clip)[source]
    facing = _facing(rest)
    world = multiply(rotations[:, source], _alignment(rest, skeleton, facing))
    scale = skeleton.leg_length_m / _leg_length(rest)
    root = scale * positions[:, source[0]]
    smoothing = _PATH_SMOOTHING_S / clip.frame_time_s
    world, root = _in_place(world, root, smoothing)
    world = flat_soles(world, skeleton, root)
    root[:, 1] -= ground_height(world, skeleton, root)
    return Movement(1.0 / clip.frame_time_s, root, continuous(_to_local(world)))


def _without_rest_row(
    positions: FloatArray, rotations: FloatArray, frame_time_s: float
) -> tuple[FloatArray, FloatArray]:
    """Drop the T-pose that some converters put before the movement: no body leaves it so fast."""
    if rotations.shape[0] > 2:
        speed = np.max(geodesic_angle(rotations[0], rotations[1])) / frame_time_s
        if speed > _FASTEST_JOINT_RAD_S:
            return positions[1:], rotations[1:]
    if rotations.shape[0] < 2:
        raise SkeletonError("A capture of one frame holds no movement: give at least two frames.")
    return positions, rotations


def _source_joints(clip: CaptureClip, joint_map: Mapping[str, str]) -> list[int]:
    missing = [name for name in JOINT_NAMES if joint_map.get(name) not in clip.names]
    if missing:
        raise SkeletonError(
            f"The capture has no joint for {', '.join(missing)}: it names {', '.join(clip.names)}."
            " Give a joint map that fits it."
        )
    return [clip.names.index(joint_map[name]) for name in JOINT_NAMES]


def _rest_positions(clip: CaptureClip) -> FloatArray:
    places = clip.offsets_m.copy()
    for joint, parent in enumerate(clip.parents):
        if parent >= 0:
            places[joint] += places[parent]
    return places


def _facing(rest: FloatArray) -> FloatArray:
    """Return the turn about y that brings our right-left axis to the capture's."""
    to_right = rest[JOINT_INDEX["RightUpperLeg"]] - rest[JOINT_INDEX["LeftUpperLeg"]]
    return _yaw(np.arctan2(-to_right[2], to_right[0]))


def _yaw(angle_rad: FloatArray) -> FloatArray:
    return from_rotation_vector(np.stack((0 * angle_rad, angle_rad, 0 * angle_rad), axis=-1))


def _alignment(rest: FloatArray, skeleton: Skeleton, facing: FloatArray) -> FloatArray:
    result = np.tile(facing, (JOINT_COUNT, 1))
    for joint, name in enumerate(JOINT_NAMES):
        if name not in _BONE_TO:
            continue
        theirs = rest[JOINT_INDEX[_BONE_TO[name]]] - rest[joint]
        if float(np.linalg.norm(theirs)) > _SHORTEST_BONE_M:
            ours = rotate(facing, skeleton.ends_m[joint])
            result[joint] = multiply(swing_between(ours, theirs), facing)
    for side in ("Left", "Right"):
        # A hand continues its forearm: captures seldom hold a finger to align it by.
        forearm = result[JOINT_INDEX[f"{side}LowerArm"]]
        result[JOINT_INDEX[f"{side}Hand"]] = forearm
    return result


def _leg_length(rest: FloatArray) -> float:
    lengths = [
        np.linalg.norm(rest[JOINT_INDEX[f"{side}{end}"]] - rest[JOINT_INDEX[f"{side}{start}"]])
        for side in ("Left", "Right")
        for start, end in (("UpperLeg", "LowerLeg"), ("LowerLeg", "Foot"))
    ]
    length = float(np.sum(lengths)) / 2.0
    if length < _SHORTEST_BONE_M:
        raise SkeletonError("The capture's legs have no length, so it cannot be scaled.")
    return length


def _in_place(
    world: FloatArray, root: FloatArray, smoothing: float
) -> tuple[FloatArray, FloatArray]:
    """Take slow heading and slow travel out of the movement."""
    forward = rotate(world[:, 0], np.array((0.0, 0.0, -1.0)))
    heading = np.unwrap(np.arctan2(-forward[:, 0], -forward[:, 2]))
    back = _yaw(-_slow(heading, smoothing))
    sway = root - np.stack(
        (_slow(root[:, 0], smoothing), np.zeros(len(root)), _slow(root[:, 2], smoothing)), axis=-1
    )
    return multiply(back[:, np.newaxis], world), rotate(back, sway)


def _slow(values: FloatArray, smoothing: float) -> FloatArray:
    """Return the slow part: the straight line through the values plus its smoothed remainder."""
    from scipy.ndimage import gaussian_filter1d  # slow to load; a server never retargets

    frames = np.arange(len(values))
    line = np.polyval(np.polyfit(frames, values, 1), frames)
    rest = gaussian_filter1d(values - line, smoothing, mode="nearest")
    return np.asarray(line + rest, dtype=np.float64)


def _to_local(world: FloatArray) -> FloatArray:
    local = world.copy()
    parents = list(PARENTS[1:])
    local[:, 1:] = multiply(conjugate(world[:, parents]), world[:, 1:])
    return normalise(local)
