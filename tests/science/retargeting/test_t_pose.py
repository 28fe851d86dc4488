"""Tests of the T-pose: properties that hold for any skeleton."""

from collections.abc import Iterator
from functools import lru_cache

import numpy as np
import pytest

from app.science.retargeting.axes import CANONICAL, UNREAL, Axes, AxesError, swing
from app.science.retargeting.joint_map import JointMapError
from app.science.retargeting.mannequin import MANNEQUIN_MAP, mannequin
from app.science.retargeting.t_pose import TPose, t_pose
from app.science.rig import Rig, to_world
from app.science.rotations import FloatArray, geodesic_angle, identity, multiply, rotate
from tests.science.retargeting.bodies import SAME, own_body, random_body
from tests.support.repetitions import usually

BODIES = usually(250, at_length=1000)


def _random_bodies(seed: int) -> Iterator[Rig]:
    rng = np.random.default_rng(seed)
    return (random_body(rng, along_axes_share=1 / 3) for _ in range(BODIES))


@lru_cache
def _aligned() -> tuple[TPose, ...]:
    return tuple(t_pose(rig, SAME) for rig in _random_bodies(5))


def _gaps_of_positions(pose: TPose) -> FloatArray:
    """Return |k - v| of each bone's direction k and axis v, by forward kinematics."""
    positions, _ = to_world(pose.rig, pose.rig.offsets_m[0], pose.local_rotations)
    order = list(SAME)
    gaps = []
    for bone in pose.bones:
        following = pose.rig.names.index(order[order.index(bone.body_joint) + 1])
        k = positions[following] - positions[bone.joint]
        gaps.append(np.linalg.norm(k / np.linalg.norm(k) - rotate(pose.facing, bone.axis)))
    return np.array(gaps)


def test_every_bone_lies_on_its_axis() -> None:
    """Every bone of random bodies lies on its axis: |k - v| <= 1e-9, antiparallel ones too."""
    poses = _aligned()
    assert len(poses) == BODIES
    assert all(len(pose.bones) >= 13 for pose in poses)
    assert max(float(np.max(_gaps_of_positions(pose))) for pose in poses) <= 1e-9
    assert max(float(np.max(pose.misalignment())) for pose in poses) <= 1e-12


def test_antiparallel_bones_are_among_the_random_ones() -> None:
    """The random bodies include bones exactly against their axis, and within 1e-6 of that."""
    angles = []
    for pose in _aligned():
        world = pose.rig.rest_world()[1]
        for bone in pose.bones:
            k = rotate(world[bone.joint], bone.direction)
            v = rotate(pose.facing, bone.axis)
            angles.append(np.linalg.norm(k / np.linalg.norm(k) + v))
    assert sum(gap == 0.0 for gap in angles) > 100
    assert sum(0.0 < gap < 1e-6 for gap in angles) > 100


def test_single_precision_keeps_its_digits() -> None:
    """In float32 every bone of random bodies lies on its axis to |k - v| <= 1e-6."""
    poses = [t_pose(rig, SAME, dtype=np.float32) for rig in _random_bodies(5)]
    assert {pose.local_rotations.dtype for pose in poses} == {np.dtype(np.float32)}
    assert max(float(np.max(pose.misalignment())) for pose in poses) <= 1e-6


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_a_swing_lands_on_its_end_at_any_angle(dtype: type) -> None:
    """A swing maps start to end to a few roundings, for angles from 1e-20 to half a turn."""
    rng = np.random.default_rng(11)
    worst = 0.0
    for _ in range(2000):
        v = rng.normal(size=3)
        sign = rng.choice((-1.0, 1.0))
        k = sign * v + 10.0 ** rng.uniform(-20, 1) * rng.normal(size=3)
        start: FloatArray = np.array(v / np.linalg.norm(v), dtype=dtype)
        end: FloatArray = np.array(k / np.linalg.norm(k), dtype=dtype)
        landed = rotate(swing(start, end).astype(np.float64), start.astype(np.float64))
        worst = max(worst, float(np.linalg.norm(landed - end)))
    assert worst <= 10 * np.finfo(dtype).eps


def test_an_own_body_is_in_its_t_pose_already() -> None:
    """The product's body, whose rest pose is the T-pose, is unchanged by alignment."""
    rig = own_body(1.7)
    pose = t_pose(rig, SAME)
    np.testing.assert_array_equal(pose.local_rotations, identity(22))
    np.testing.assert_array_equal(pose.positions_m, rig.rest_world()[0])
    np.testing.assert_array_equal(pose.facing, identity())


def test_a_t_pose_of_a_t_pose_is_itself() -> None:
    """Aligning a T-pose again changes nothing."""
    rng = np.random.default_rng(2)
    for _ in range(50):
        rig = random_body(rng)
        once = t_pose(rig, SAME)
        twice = t_pose(Rig(rig.names, rig.parents, rig.offsets_m, once.local_rotations), SAME)
        # Hip sockets may have turned with the pelvis, and so has the body's facing.
        if float(geodesic_angle(once.facing, twice.facing)) < 1e-9:
            turn = geodesic_angle(once.local_rotations, twice.local_rotations)
            assert float(np.max(turn)) < 1e-7


@pytest.mark.parametrize("yaw_deg", [0.0, 90.0, 180.0, -37.0])
def test_a_body_is_aligned_in_its_own_facing(yaw_deg: float) -> None:
    """A body whose rest pose faces another way has the same T-pose, facing that way."""
    half = np.radians(yaw_deg) / 2
    turn = np.array((np.cos(half), 0.0, np.sin(half), 0.0))
    rig = random_body(np.random.default_rng(8))
    rest = rig.rest_rotations.copy()
    rest[0] = multiply(turn, rest[0])
    here, there = (
        t_pose(rig, SAME),
        t_pose(Rig(rig.names, rig.parents, rig.offsets_m, rest), SAME),
    )
    assert float(geodesic_angle(there.facing, multiply(turn, here.facing))) < 1e-12
    gap = geodesic_angle(there.world_rotations, multiply(turn, here.world_rotations))
    assert float(np.max(gap)) < 1e-9


def test_feet_and_head_are_as_at_rest_in_the_world() -> None:
    """Feet and head keep the world orientation that they have at rest."""
    rig = random_body(np.random.default_rng(21))
    rest, pose = rig.rest_world()[1], t_pose(rig, SAME)
    for name in ("LeftFoot", "RightFoot", "Head"):
        joint = rig.index(name)
        assert float(geodesic_angle(rest[joint], pose.world_rotations[joint])) < 1e-12


def test_joints_that_are_not_aligned_keep_their_local_rotation() -> None:
    """Collar bones, toes, hands without a finger and extra joints keep their local rotation."""
    rig = random_body(np.random.default_rng(21))
    pose = t_pose(rig, SAME)
    still = [n for n in rig.names if n.startswith("between") or "Shoulder" in n or "Toes" in n]
    for name in (*still, "LeftHand", "RightHand"):
        joint = rig.index(name)
        turn = geodesic_angle(rig.rest_rotations[joint], pose.local_rotations[joint])
        assert float(turn) < 1e-9


def test_a_hand_is_aligned_by_its_longest_finger() -> None:
    """A bent wrist is straightened along the fingers, not along the thumb."""
    body = own_body(1.7)
    hand = body.index("LeftHand")
    fingers = ((hand, (-0.08, -0.12, 0.0)), (hand, (-0.02, 0.0, -0.05)))
    rig = Rig(body.names, body.parents, body.offsets_m, body.rest_rotations, fingers)
    pose = t_pose(rig, SAME)
    finger = rotate(pose.world_rotations[hand], np.array(fingers[0][1]))
    np.testing.assert_allclose(finger / np.linalg.norm(finger), (-1.0, 0.0, 0.0), atol=1e-12)


def test_a_bone_of_no_length_turns_nothing() -> None:
    """A bone of zero length, such as CMU's lower back, turns nothing and raises no error."""
    body = own_body(1.7)
    offsets = body.offsets_m.copy()
    offsets[body.index("Spine")] = 0.0
    pose = t_pose(Rig(body.names, body.parents, offsets, body.rest_rotations), SAME)
    assert "Hips" not in {bone.body_joint for bone in pose.bones}
    np.testing.assert_array_equal(pose.local_rotations, identity(22))


def test_the_mannequin_faces_forward_in_unreals_axes() -> None:
    """The mannequin's T-pose has the left arm on +x, z up and the toes towards +y."""
    pose = t_pose(mannequin(), MANNEQUIN_MAP, UNREAL)
    toes, heel = (pose.positions_m[pose.rig.index(name)] for name in ("ball_l", "foot_l"))
    assert float(np.dot(toes - heel, UNREAL.forward)) > 0.15
    assert float(geodesic_angle(pose.facing, identity())) < 1e-9
    assert CANONICAL.forward == pytest.approx((0.0, 0.0, -1.0))


def test_axes_must_span_a_frame() -> None:
    """Axes that are not perpendicular raise an error that states their values."""
    with pytest.raises(AxesError, match="perpendicular"):
        Axes(up=(0.0, 1.0, 0.0), left=(0.0, 1.0, 0.0))


def test_a_map_that_does_not_fit_is_rejected() -> None:
    """An unknown joint in a joint map raises an error that lists the existing joints."""
    with pytest.raises(JointMapError, match="'Pelvis'"):
        t_pose(own_body(1.7), {**SAME, "Hips": "Pelvis"})
