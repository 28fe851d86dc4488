"""Take the movement of fingers out of a capture.

Fingers are transferred like the rest of the body (`transfer`): a finger part turns in the world as
the capture's bone does, relative to the T-pose, so its rotation in the part above it is

    D_j = world_from_bone_j(t) world_from_bone_j(T-pose)^-1,   parent_from_part = D_above^-1 D_j,

turned into the direction in which the body faces. In the T-pose fingers point outwards and thumbs
45 degrees forward; each bone is brought there from its rest by the shortest turn, after the hand.
How a rig's fingers are bent at rest therefore does not matter; only how they are rolled about their
own axes does. Parts that a capture lacks stay as in the T-pose.
"""

from math import sqrt

import numpy as np

from app.science.retargeting.axes import swing, unit
from app.science.retargeting.finger_names import finger_bones_of
from app.science.retargeting.joint_map import JointMap
from app.science.retargeting.t_pose import TPose, t_pose
from app.science.rig import Rig, RigMotion, to_world
from app.science.rotations import FloatArray, conjugate, identity, multiply, rotate
from app.science.skeleton import FINGER_COUNT, FINGER_PARTS, FINGERS, SEGMENTS, finger_of

_SHORTEST_BONE_M = 1e-4


def has_fingers(rig: Rig, joint_map: JointMap) -> bool:
    """Return whether each hand of a rig has a whole finger, with three bones."""
    found = finger_bones_of(rig, {part: rig.index(name) for part, name in joint_map.items()})
    return all(
        any(all(f"{side}{finger}{one}" in found for one in SEGMENTS) for finger in FINGERS)
        for side in ("Left", "Right")
    )


def captured_fingers(source: RigMotion, joint_map: JointMap) -> FloatArray:
    """Return the local rotations (N, 30, 4) of the finger parts in every frame of a capture.

    Raises:
        JointMapError: the map does not match the capture's skeleton.
    """
    rig = source.rig
    pose = t_pose(rig, joint_map)
    bones = finger_bones_of(rig, {part: rig.index(name) for part, name in joint_map.items()})
    rest = _world_in_t_pose(pose, bones)
    _, world = to_world(rig, source.root_positions_m, source.rotations)
    fingers = identity(source.frame_count, FINGER_COUNT)
    for row, part in enumerate(FINGER_PARTS):
        if part not in bones:
            continue
        side = "Left" if part.startswith("Left") else "Right"
        segment = row % len(SEGMENTS)
        above = rig.index(joint_map[f"{side}Hand"])
        if segment and FINGER_PARTS[row - 1] in bones:
            above = bones[FINGER_PARTS[row - 1]]
        turned = multiply(world[:, bones[part]], conjugate(rest[bones[part]]))
        carried = multiply(world[:, above], conjugate(rest[above]))
        fingers[:, row] = multiply(conjugate(carried), turned)
    return multiply(conjugate(pose.facing), multiply(fingers, pose.facing))


def _world_in_t_pose(pose: TPose, bones: dict[str, int]) -> FloatArray:
    """Return world_from_joint (J, 4) of the T-pose with its fingers stretched."""
    rig, world = pose.rig, pose.world_rotations.copy()
    part_of = {bone: part for part, bone in bones.items()}
    places, rest_world = rig.rest_world()
    ends = dict(rig.ends)
    below = {bone for bone in range(rig.joint_count) if bone in part_of}
    for joint, parent in enumerate(rig.parents):
        if parent in below:
            below.add(joint)
        if joint not in below:
            continue
        world[joint] = unit(multiply(world[parent], rig.rest_rotations[joint]))
        if joint not in part_of:
            continue
        part = part_of[joint]
        outer = _next_part(part)
        if outer in bones:
            away = places[bones[outer]] - places[joint]
            direction = rotate(conjugate(rest_world[joint]), away)
        else:
            direction = np.array(ends.get(joint, (0.0, 0.0, 0.0)))
        if float(np.linalg.norm(direction)) > _SHORTEST_BONE_M:
            goal = rotate(pose.facing, _straight(pose, part))
            now = rotate(world[joint], unit(direction))
            forward = rotate(pose.facing, np.array(pose.axes.forward))
            world[joint] = unit(multiply(conjugate(swing(goal, now, forward)), world[joint]))
    return world


def _next_part(part: str) -> str:
    at = FINGER_PARTS.index(part)
    return FINGER_PARTS[at + 1] if (at + 1) % len(SEGMENTS) else ""


def _straight(pose: TPose, part: str) -> FloatArray:
    """Return the direction of a finger in the T-pose, in the pose's axes."""
    outwards = pose.axes.left_array() if part.startswith("Left") else -pose.axes.left_array()
    if finger_of(part) != "Thumb":
        return outwards
    slanted: FloatArray = (outwards + np.array(pose.axes.forward)) / sqrt(2.0)
    return slanted
