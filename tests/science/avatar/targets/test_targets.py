"""Tests of converting poses to hinge angles and back: properties, gimbal lock, captures."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from app.science.avatar.body.parts import AXES_OF, AXIS_NAMES, FINGER_PARTS, PART_NAMES
from app.science.avatar.configuration.limits import ANATOMIC
from app.science.avatar.targets.targets import (
    TargetAngles,
    TargetError,
    joint_rotations,
    rotations_of,
)
from app.science.rotations import (
    FloatArray,
    from_rotation_vector,
    geodesic_angle,
    identity,
    multiply,
    normalise,
    rotate,
)
from app.science.skeleton import JOINT_INDEX, JOINT_NAMES, PARENTS
from tests.science.avatar.captured import REACH, WALKS, captured

LOW = np.array([ANATOMIC[name].low_rad for name in AXIS_NAMES])
HIGH = np.array([ANATOMIC[name].high_rad for name in AXIS_NAMES])


@dataclass(frozen=True)
class _Turns:
    low_rad: float = -4.0
    high_rad: float = 4.0


ANYWHERE = dict.fromkeys(AXIS_NAMES, _Turns())


def _random_pose(rng: np.random.Generator) -> FloatArray:
    return normalise(rng.normal(size=(len(JOINT_NAMES), 4)))


def _orientations(rotations: FloatArray) -> FloatArray:
    world = rotations.copy()
    for joint in range(1, len(PARENTS)):
        world[..., joint, :] = multiply(world[..., PARENTS[joint], :], rotations[..., joint, :])
    return world


def _column(name: str) -> int:
    return AXIS_NAMES.index(name)


def test_angles_within_the_limits_come_back() -> None:
    """Angles converted to rotations and back are the same to 1e-10, fingers included."""
    rng = np.random.default_rng(1)
    follower = TargetAngles(ANATOMIC)
    for _ in range(200):
        angles = rng.uniform(LOW, HIGH)
        parts = rotations_of(angles)
        follower.forget()
        found = follower.follow(
            joint_rotations(angles, identity()), {part: parts[part] for part in FINGER_PARTS}
        )
        np.testing.assert_allclose(found.angles_rad, angles, atol=1e-10)
        np.testing.assert_allclose(found.residual_rad, 0.0, atol=1e-7)


def test_three_axes_make_every_rotation() -> None:
    """Unbounded axes reproduce any pose to 1e-10, with the collar bone's turn in the arm."""
    rng = np.random.default_rng(2)
    follower = TargetAngles(ANYWHERE)
    joints = [name for name in JOINT_NAMES if len(AXES_OF[name]) == 3 and "UpperLeg" not in name]
    for _ in range(200):
        pose = _random_pose(rng)
        made = joint_rotations(follower.follow(pose).unclamped_rad, pose[0])
        expected = pose.copy()
        for side in ("Left", "Right"):
            arm, shoulder = JOINT_INDEX[f"{side}UpperArm"], JOINT_INDEX[f"{side}Shoulder"]
            expected[arm] = multiply(pose[shoulder], pose[arm])
        rows = [JOINT_INDEX[name] for name in joints]
        assert geodesic_angle(made[rows], expected[rows]).max() < 1e-10


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_gimbal_lock_is_passed_with_the_least_change(side: float) -> None:
    """At a gimbal lock the pose is still met and no angle moves more than the pose does."""
    axes = [axis.name for axis in AXES_OF["LeftUpperArm"]]
    columns = [_column(name) for name in axes]
    follower = TargetAngles(ANYWHERE)
    angles = np.zeros(len(AXIS_NAMES))
    angles[columns] = 0.4, side * math.pi / 2, -0.3
    follower.follow(joint_rotations(angles, identity()))
    before = follower.follow(joint_rotations(angles, identity())).unclamped_rad[columns]
    angles[columns[0]] += 0.1
    pose = joint_rotations(angles, identity())
    found = follower.follow(pose).unclamped_rad
    assert np.abs(found[columns] - before).max() == pytest.approx(0.05, abs=1e-6)
    assert geodesic_angle(joint_rotations(found, identity()), pose).max() < 1e-10


def test_whole_turns_do_not_add_up() -> None:
    """A head that keeps turning round never has a target beyond 225 deg."""
    follower = TargetAngles(ANYWHERE)
    angles = np.zeros(len(AXIS_NAMES))
    for turned in np.linspace(0.0, 6.0 * math.pi, 600):
        angles[_column("HeadY")] = turned
        targets_rad = follower.follow(joint_rotations(angles, identity())).unclamped_rad
        assert abs(targets_rad[_column("HeadY")]) <= math.radians(225.0) + 1e-9


def test_a_knee_and_an_elbow_that_bend_askew_keep_all_below_them_in_place() -> None:
    """Where knees and elbows bend askew, the parts below them keep their orientation."""
    rng = np.random.default_rng(3)
    follower = TargetAngles(ANATOMIC)
    for _ in range(100):
        pose = identity(len(JOINT_NAMES))
        bones = {}
        for side, out in (("Left", -1.0), ("Right", 1.0)):
            askew = rng.uniform(-0.6, 0.6)
            bend = np.array([0.0, -out * math.cos(askew), math.sin(askew)])
            pose[JOINT_INDEX[f"{side}LowerArm"]] = from_rotation_vector(
                -rng.uniform(0.5, 2.0) * bend
            )
            bend = np.array([-math.cos(askew), 0.0, math.sin(askew)])
            pose[JOINT_INDEX[f"{side}LowerLeg"]] = from_rotation_vector(
                rng.uniform(0.5, 2.0) * bend
            )
            bones[f"{side}UpperArm"] = np.array([out, 0.0, 0.0])
            bones[f"{side}UpperLeg"] = np.array([0.0, -1.0, 0.0])
        follower.forget()
        found = follower.follow(pose)
        made, requested = (
            _orientations(joint_rotations(found.unclamped_rad, pose[0])),
            _orientations(pose),
        )
        below = [JOINT_INDEX[f"{side}{part}"] for side in ("Left", "Right")
                 for part in ("LowerArm", "Hand", "Foot")]  # fmt: skip
        assert geodesic_angle(made[below], requested[below]).max() < math.radians(6.0)
        for name, bone in bones.items():
            row = JOINT_INDEX[name]
            np.testing.assert_allclose(
                rotate(made[row], bone), rotate(requested[row], bone), atol=1e-9
            )
        elbows = [_column("LeftLowerArmZ"), _column("RightLowerArmZ")]
        assert np.abs(found.unclamped_rad[elbows]).max() < math.radians(6.0)


def test_a_forearm_takes_over_what_a_wrist_cannot_turn() -> None:
    """A hand turned by 40 deg about the forearm is reached by turning the forearm."""
    pose = identity(len(JOINT_NAMES))
    hand = JOINT_INDEX["LeftHand"]
    pose[hand] = from_rotation_vector(np.array([-math.radians(40.0), 0.0, 0.0]))
    found = TargetAngles(ANATOMIC).follow(pose)
    assert not found.clipped.any()
    made = _orientations(joint_rotations(found.angles_rad, pose[0]))
    assert geodesic_angle(made[hand], pose[hand]) < 1e-10


def test_two_axes_come_as_near_as_they_can() -> None:
    """The two angles of a proximal finger come as near to any rotation as possible."""
    rng = np.random.default_rng(4)
    part = "LeftIndexProximal"
    columns = [_column(axis.name) for axis in AXES_OF[part]]
    follower = TargetAngles(ANYWHERE)
    for _ in range(50):
        requested = from_rotation_vector(rng.normal(size=3))
        follower.forget()
        found = follower.follow(identity(len(JOINT_NAMES)), {part: requested})
        missed = found.residual_rad[PART_NAMES.index(part)]
        tried = np.tile(found.unclamped_rad, (200, 1))
        assert geodesic_angle(rotations_of(tried[0])[part], requested) == pytest.approx(
            missed, abs=1e-7
        )
        tried[:, columns] += rng.normal(scale=0.3, size=(200, 2))
        assert np.all(geodesic_angle(rotations_of(tried)[part], requested) >= missed - 1e-9)


def test_the_turn_of_a_missing_part_goes_to_its_children() -> None:
    """Without chest, upper chest and neck, head and arms keep their orientation in the world."""
    rng = np.random.default_rng(5)
    parts = [part for part in PART_NAMES if part not in {"Chest", "UpperChest", "Neck"}]
    pose = from_rotation_vector(rng.normal(scale=0.3, size=(len(JOINT_NAMES), 3)))
    found = TargetAngles(ANYWHERE, parts).follow(pose)
    made, requested = (
        _orientations(joint_rotations(found.unclamped_rad, pose[0])),
        _orientations(pose),
    )
    rows = [JOINT_INDEX[name] for name in ("Spine", "Head", "LeftHand", "RightLowerArm")]
    assert geodesic_angle(made[rows], requested[rows]).max() < 1e-10
    assert found.unclamped_rad[_column("ChestX")] == 0.0


def test_what_is_beyond_the_limits_is_clamped_and_counted() -> None:
    """A knee bent backwards in one of two frames is clamped there; its clipped share is a half."""
    poses = identity(2, len(JOINT_NAMES))
    angles = np.zeros(len(AXIS_NAMES))
    angles[_column("LeftLowerLegX")] = -0.04
    poses[1] = joint_rotations(angles, identity())
    found = TargetAngles(ANATOMIC).batch(poses)
    knee = _column("LeftLowerLegX")
    assert found.angles_rad[1, knee] == 0.0
    assert found.unclamped_rad[1, knee] == pytest.approx(-0.04)
    assert found.clipped_share()[knee] == 0.5
    assert found.clipped_share().sum() == 0.5


@pytest.mark.parametrize("name", [*WALKS, REACH])
def test_real_movements_have_no_jumps(shared_data: Path, name: str) -> None:
    """In real movements no axis turns faster than a swinging foot, 20 rad/s."""
    movement = captured(shared_data, name)
    found = TargetAngles(ANATOMIC).batch(movement.rotations)
    steps = np.abs(np.diff(found.unclamped_rad, axis=0)) * movement.rate_hz
    assert steps.max() < 20.0
    np.testing.assert_array_less(np.abs(found.velocities_rad_s(movement.rate_hz)), 20.0)


def test_wrong_shapes_and_missing_limits_are_rejected() -> None:
    """Errors about wrong shapes and missing limits name what was given."""
    with pytest.raises(TargetError, match=r"\(21, 4\)"):
        TargetAngles(ANATOMIC).follow(identity(21))
    with pytest.raises(TargetError, match="SpineX"):
        TargetAngles({})
