"""Tests of targets relative to the parent joint, and of targets in the space of the room."""

import math

import numpy as np
import pytest

from app.science.avatar.body.parts import AXIS_NAMES
from app.science.avatar.configuration.configuration import TargetSpace
from app.science.avatar.simulation.following import Follower
from app.science.rotations import geodesic_angle, identity
from app.science.skeleton import FINGER_PARTS, JOINT_INDEX
from tests.science.avatar.captured import RATE_HZ
from tests.science.avatar.simulated import angles, avatar, model, target_angles

HIPS_M = np.array([0.0, 0.954, 0.0])
PUSH_NM = 150.0


def _pushed(target_space: TargetSpace) -> dict[str, float]:
    """Return by how many degrees the parts turned after a sideways push on the chest for 1 s."""
    body, pose = avatar(), identity(len(JOINT_INDEX))
    follower = Follower(body, target_angles(model()), target_space=target_space)
    follower.start(HIPS_M, pose)
    body.data.xfrc_applied[body.model.body("UpperChest").id, 5] = PUSH_NM
    for frame in range(1, 91):
        follower.frame(frame / RATE_HZ, HIPS_M, pose)
    rows = [body.model.body(name).id for name in JOINT_INDEX]
    turned = geodesic_angle(body.data.xquat[rows], identity())
    return {name: math.degrees(turned[row]) for name, row in JOINT_INDEX.items()}


def test_a_pushed_trunk_drags_hands_and_head_only_in_joint_space() -> None:
    """With targets in world space, head and arms turn less than half as far as a pushed trunk."""
    local, world = _pushed("local"), _pushed("world")
    assert local["UpperChest"] > 2.0
    assert world["UpperChest"] == pytest.approx(local["UpperChest"], rel=0.2)
    for part in ("Head", "LeftUpperArm", "LeftHand", "RightHand"):
        assert local[part] > 2.0
        assert world[part] < world["UpperChest"] / 2
    assert world["Head"] < 0.3


@pytest.mark.parametrize("target_space", ["local", "world"])
def test_latency_delays_the_limbs_in_both_spaces(target_space: TargetSpace) -> None:
    """With a delay of 0.2 s an elbow is at rest after 0.1 s and has moved after half a second."""
    body = avatar()
    built = model()
    follower = Follower(body, target_angles(built), target_space=target_space, delay_s=0.2)
    pose = identity(len(JOINT_INDEX))
    follower.start(HIPS_M, pose)
    follower.frame(1 / RATE_HZ, HIPS_M, pose)
    bent = pose.copy()
    bent[JOINT_INDEX["LeftLowerArm"]] = (math.cos(0.5), 0.0, -math.sin(0.5), 0.0)
    elbow = AXIS_NAMES.index("LeftLowerArmY")
    seen = [
        follower.frame((frame + 1) / RATE_HZ, HIPS_M, bent).state.angles_rad[elbow]
        for frame in range(1, 60)
    ]
    assert abs(seen[9]) < 0.02
    assert seen[-1] == pytest.approx(1.0, abs=0.03)


def test_a_body_starts_in_its_start_pose_without_moving() -> None:
    """A body that starts in a pose is in that pose in its first frame."""
    body = avatar()
    pose = identity(len(JOINT_INDEX))
    pose[JOINT_INDEX["RightLowerArm"]] = (math.cos(0.4), 0.0, math.sin(0.4), 0.0)
    follower = Follower(body, target_angles(model()), delay_s=0.3)
    follower.start(HIPS_M, pose)
    state = follower.frame(1 / RATE_HZ, HIPS_M, pose).state
    expected = angles(RightLowerArmY=0.8)
    present = ~np.isnan(state.angles_rad)
    np.testing.assert_allclose(state.angles_rad[present], expected[present], atol=0.01)


@pytest.mark.parametrize("target_space", ["local", "world"])
def test_latency_delays_the_fingers_in_both_spaces(target_space: TargetSpace) -> None:
    """With a delay of 0.2 s a thumb is at rest after 0.1 s and follows, all at once or by name."""
    built = model(fingers=True)
    bend = AXIS_NAMES.index("RightThumbDistalY")
    pose, resting, bent = identity(len(JOINT_INDEX)), identity(30), identity(30)
    half = math.radians(20.0)
    bent[FINGER_PARTS.index("RightThumbDistal")] = (math.cos(half), 0.0, -math.sin(half), 0.0)
    for named in (False, True):
        body = avatar(fingers=True)
        follower = Follower(body, target_angles(built), target_space=target_space, delay_s=0.2)
        given = [dict(zip(FINGER_PARTS, q, strict=True)) if named else q for q in (resting, bent)]
        follower.start(HIPS_M, pose, given[0])
        follower.frame(1 / RATE_HZ, HIPS_M, pose, given[0])
        seen = [
            follower.frame((frame + 1) / RATE_HZ, HIPS_M, pose, given[1]).state.angles_rad[bend]
            for frame in range(1, 60)
        ]
        assert abs(seen[9]) < 0.02
        assert seen[-1] == pytest.approx(2.0 * half, abs=0.02)
        turned = geodesic_angle(body.finger_rotations(), bent)
        assert np.degrees(turned).max() < 1.5
