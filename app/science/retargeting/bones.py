"""Find the bones of a rig that a T-pose aligns, their target axes, and the rig's facing at rest."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.science.retargeting.axes import Axes
from app.science.retargeting.joint_chains import is_below
from app.science.retargeting.joint_map import JointMap, check_joint_map
from app.science.rig import Rig
from app.science.rotations import FloatArray, Vector, conjugate, identity, rotate
from app.science.skeleton import JOINT_NAMES

_TORSO = ("Hips", "Spine", "Chest", "UpperChest", "Neck", "Head")
_ARM = ("UpperArm", "LowerArm", "Hand")
_LEG = ("UpperLeg", "LowerLeg", "Foot")
_SHORTEST_BONE_M = 1e-4
_STRAIGHT_ON = 0.5
"""Cosine of 60 degrees: a finger bent further does not indicate the hand's direction."""


@dataclass(frozen=True, eq=False)
class Bone:
    """A bone that is aligned by turning one joint.

    Attributes:
        body_joint: name of the joint of the body.
        joint: index in the rig.
        direction: (3,) direction of the bone in the joint's own frame, of any length above
            zero.
        axis: (3,) unit vector it is aligned to, in the axes (before the rig's facing).
    """

    body_joint: str
    joint: int
    direction: FloatArray
    axis: FloatArray


def joints_of(rig: Rig, joint_map: JointMap) -> dict[str, int]:
    """Return the rig's joint index of each mapped body joint, in the skeleton's order.

    Raises:
        JointMapError: the map does not match the rig.
    """
    check_joint_map(rig, joint_map)
    return {name: rig.index(joint_map[name]) for name in JOINT_NAMES if name in joint_map}


def bones_of(
    rig: Rig, joints: Mapping[str, int], axes: Axes, local_axes: Mapping[str, Vector]
) -> tuple[Bone, ...]:
    """Return the bones to align, ordered from root to leaf."""
    up, left = axes.up_array(), axes.left_array()
    limbs: list[tuple[tuple[str, ...], FloatArray]] = [(_TORSO, up)]
    for side, outwards in (("Left", left), ("Right", -left)):
        limbs.append((tuple(f"{side}{part}" for part in _ARM), outwards))
        limbs.append((tuple(f"{side}{part}" for part in _LEG), -up))
    bones = []
    for limb, axis in limbs:
        chain = [name for name in limb if name in joints]
        for at, name in enumerate(chain):
            if name in local_axes:
                direction = np.array(local_axes[name])
            else:
                direction = _direction(rig, [joints[each] for each in chain], at, limb)
            if float(np.linalg.norm(direction)) > _SHORTEST_BONE_M:
                bones.append(Bone(name, joints[name], direction, axis))
    return tuple(sorted(bones, key=lambda bone: bone.joint))


def _direction(rig: Rig, chain: list[int], at: int, limb: tuple[str, ...]) -> FloatArray:
    """Return the bone of one joint of a limb in the joint's own frame; zero if it has none."""
    places, world = rig.rest_world()
    joint = chain[at]
    bone = np.zeros(3)
    if at + 1 < len(chain):
        if is_below(rig, chain[at + 1], joint):
            bone = places[chain[at + 1]] - places[joint]
    elif limb[-1].endswith("Hand") and at > 0:
        bone = _longest_finger(rig, joint, places, world, places[joint] - places[chain[at - 1]])
    return rotate(conjugate(world[joint]), bone)


def points_below(rig: Rig, joint: int, places: FloatArray, world: FloatArray) -> FloatArray:
    """Return the positions of joints and free ends below a joint, (P, 3) in the world."""
    below = [other for other in range(rig.joint_count) if is_below(rig, other, joint)]
    points = [places[other] for other in below if other != joint]
    points += [
        places[other] + rotate(world[other], np.array(end))
        for other, end in rig.ends
        if other in below
    ]
    return np.array(points).reshape(-1, 3)


def rest_facing(rig: Rig, joints: Mapping[str, int], axes: Axes) -> FloatArray:
    """Return the rotation about up, (4,), that brings `axes.left` to the rig's left at rest.

    Left is determined from the hip joints, else from the shoulders; without either the rig is
    assumed to face as the axes do.
    """
    places = rig.rest_world()[0]
    up = axes.up_array()
    for part in ("UpperLeg", "UpperArm", "Shoulder", "LowerLeg", "Hand"):
        if f"Left{part}" in joints and f"Right{part}" in joints:
            across = places[joints[f"Left{part}"]] - places[joints[f"Right{part}"]]
            level = across - up * float(np.dot(across, up))
            if float(np.linalg.norm(level)) > _SHORTEST_BONE_M:
                return _turn_about(up, axes.left_array(), level)
    return identity()


def _turn_about(up: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    cosine = float(np.dot(start, end))
    sine = float(np.dot(up, np.cross(start, end)))
    half = 0.5 * np.arctan2(sine, cosine)
    return np.array((np.cos(half), *(np.sin(half) * up)))


def _longest_finger(
    rig: Rig, joint: int, places: FloatArray, world: FloatArray, forearm: FloatArray
) -> FloatArray:
    """Return the vector from a hand to the farthest point below it, in the world.

    Zero if there is no such point, or if its direction deviates too much from the forearm's.
    """
    ways = points_below(rig, joint, places, world) - places[joint]
    if not len(ways):
        return np.zeros(3)
    longest = ways[np.argmax(np.linalg.norm(ways, axis=1))]
    straight = float(np.dot(longest, forearm))
    shows = straight > _STRAIGHT_ON * float(np.linalg.norm(longest) * np.linalg.norm(forearm))
    return np.asarray(longest if shows else np.zeros(3))
