"""Tests of the fingers of captures: names, rest poses and directions do not matter."""

import numpy as np
import pytest

from app.science.avatar.body import finger_bones
from app.science.retargeting import (
    REFERENCE_JOINT_MAP,
    captured_fingers,
    finger_bones_of,
    has_fingers,
    reference_avatar,
)
from app.science.rig import Rig, RigMotion
from app.science.rotations import FloatArray, from_rotation_vector, identity, multiply, rotate
from app.science.rotations import conjugate as inverse
from app.science.simulation import SimulatedFingers
from app.science.skeleton import FINGER_PARTS, JOINT_INDEX, finger_of

HAND_M = 0.18
BODY = 22


def rig_with_hands(bend: FloatArray, facing: FloatArray) -> Rig:
    """Return a body in T-pose, turned by `facing`, whose fingers are bent at rest by `bend`."""
    body = reference_avatar(1.72)
    names, parents = list(body.names), list(body.parents)
    offsets, rests = [*body.offsets_m], [*body.rest_rotations]
    offsets[0], rests[0] = rotate(facing, offsets[0]), multiply(facing, rests[0])
    ends = []
    for side in ("Left", "Right"):
        above = JOINT_INDEX[f"{side}Hand"]
        for bone in finger_bones(side, HAND_M):
            if bone.part.endswith("Proximal"):
                above = JOINT_INDEX[f"{side}Hand"]
            parents.append(above)
            above = len(names)
            row = FINGER_PARTS.index(bone.part)
            names.append(f"mixamorig:{side}Hand{finger_of(bone.part)}{row % 3 + 1}")
            offsets.append(np.array(bone.joint_m))
            rests.append(bend[row])
            if bone.part.endswith("Distal"):
                ends.append((above, bone.end_m))
    return Rig(tuple(names), tuple(parents), np.array(offsets), np.array(rests), tuple(ends))


@pytest.mark.parametrize("heading_deg", [0.0, 130.0])
def test_the_fingers_of_a_capture_are_recovered_whatever_its_rest_pose(heading_deg: float) -> None:
    """Generated fingers put on a turned rig with crooked rest fingers come back as they were."""
    facing = from_rotation_vector(np.array([0.0, np.radians(heading_deg), 0.0]))
    hands = SimulatedFingers(np.random.default_rng(6))
    fingers = np.stack([hands.pose(frame / 30.0) for frame in range(60)])
    # At rest the fingers are bent about their last joints, whose one axis lies across the bone. The
    # middle finger, by which a T-pose aligns the hand, is straight.
    bend = SimulatedFingers(np.random.default_rng(7)).pose(0.0)
    straight = [part.endswith("Proximal") or "Middle" in part for part in FINGER_PARTS]
    bend[straight] = identity()
    rig = rig_with_hands(bend, facing)
    local = np.concatenate((np.tile(rig.rest_rotations[:BODY], (60, 1, 1)), fingers), axis=1)
    local[:, JOINT_INDEX["LeftUpperArm"]] = from_rotation_vector(np.array([0.3, 0.2, -1.1]))
    motion = RigMotion(rig, 30.0, np.zeros((60, 3)), local, np.ones((60, BODY + 30), np.bool_))
    assert has_fingers(rig, REFERENCE_JOINT_MAP)
    found = captured_fingers(motion, REFERENCE_JOINT_MAP)
    turn = multiply(inverse(fingers), found)
    assert np.degrees(2.0 * np.arccos(np.abs(turn[..., 0]).clip(max=1.0))).max() < 1e-3


def test_fingers_are_found_by_the_names_of_usual_rigs() -> None:
    """Bones named as rigs of Mixamo name them are the 30 finger parts."""
    rig = rig_with_hands(identity(30), identity())
    bones = {part: rig.index(name) for part, name in REFERENCE_JOINT_MAP.items()}
    found = finger_bones_of(rig, bones)
    assert tuple(found) == FINGER_PARTS
    assert not has_fingers(reference_avatar(1.72), REFERENCE_JOINT_MAP)
