"""Tests of the skeleton and its forward kinematics."""

import numpy as np
import pytest

from app.science import rotations as rot
from app.science.skeleton import (
    JOINT_INDEX,
    JOINT_NAMES,
    PARENTS,
    SkeletonError,
    body_part_segments,
    build_skeleton,
    forward_kinematics,
)


@pytest.fixture
def rng() -> np.random.Generator:
    """Return random numbers with a fixed seed."""
    return np.random.default_rng(20200417)


def test_parents_come_before_children() -> None:
    """Every joint's parent comes before it in the order of joints."""
    assert len(JOINT_NAMES) == 22
    assert all(parent < joint for joint, parent in enumerate(PARENTS))


@pytest.mark.parametrize("stature_m", [1.5, 1.75, 2.0])
def test_t_pose_stands_on_the_floor_and_reaches_the_stature(stature_m: float) -> None:
    """In the T-pose the soles are at zero and the top of the head at the stature."""
    skeleton = build_skeleton(stature_m)
    world = forward_kinematics(skeleton, skeleton.offsets_m[0], rot.identity(22))
    segments = body_part_segments(skeleton, world)
    lowest = segments.axes_m[..., 1].min(axis=1) - segments.radii_m
    highest = segments.axes_m[..., 1].max(axis=1) + segments.radii_m
    assert float(lowest.min()) == pytest.approx(0.0, abs=1e-3)
    assert float(highest.max()) == pytest.approx(stature_m)
    assert int(np.argmax(highest)) == JOINT_INDEX["Head"]


def test_t_pose_points_the_way_the_world_says() -> None:
    """In the T-pose left is -x, feet point to -z, and the arms span about the stature."""
    skeleton = build_skeleton(1.8)
    world = forward_kinematics(skeleton, np.zeros(3), rot.identity(22))
    tips = world.positions_m + skeleton.ends_m
    left, right = tips[JOINT_INDEX["LeftHand"]], tips[JOINT_INDEX["RightHand"]]
    assert left[0] < 0.0 < right[0]
    assert tips[JOINT_INDEX["LeftToes"], 2] < 0.0
    # Winter 2009, figure 4.1: 2 (.129 + .186 + .146 + .108) H = 1.138 H.
    assert float(right[0] - left[0]) == pytest.approx(1.138 * 1.8)


def test_published_segment_lengths() -> None:
    """Segment lengths are Winter's (2009) shares of the stature.

    Upper arm .186, forearm .146, thigh .245 and shank .246.
    """
    skeleton = build_skeleton(1.0)
    lengths = [
        skeleton.length_m(n) for n in ("LeftLowerArm", "LeftHand", "LeftLowerLeg", "LeftFoot")
    ]
    np.testing.assert_allclose(lengths, (0.186, 0.146, 0.245, 0.246))
    assert skeleton.leg_length_m == pytest.approx(0.491)


def test_single_frame_equals_the_batch(rng: np.random.Generator) -> None:
    """The fast path for a single frame gives the same as the batch."""
    skeleton = build_skeleton(1.7)
    roots, q = rng.normal(size=(5, 3)), rot.normalise(rng.normal(size=(5, 22, 4)))
    batch = forward_kinematics(skeleton, roots, q)
    for i in range(5):
        one = forward_kinematics(skeleton, roots[i], q[i])
        np.testing.assert_allclose(one.positions_m, batch.positions_m[i], atol=1e-13)
        np.testing.assert_allclose(one.rotations, batch.rotations[i], atol=1e-13)


def test_bone_lengths_never_change(rng: np.random.Generator) -> None:
    """A joint keeps its distance from its parent, whatever the rotations."""
    skeleton = build_skeleton(1.7)
    world = forward_kinematics(
        skeleton, np.zeros((50, 3)), rot.normalise(rng.normal(size=(50, 22, 4)))
    )
    bones = world.positions_m[:, 1:] - world.positions_m[:, list(PARENTS[1:])]
    expected = np.linalg.norm(skeleton.offsets_m[1:], axis=1)
    np.testing.assert_allclose(np.linalg.norm(bones, axis=2), np.tile(expected, (50, 1)))


def test_moving_the_root_moves_the_whole_body(rng: np.random.Generator) -> None:
    """A rigid motion of the hips moves every joint by the same rigid motion."""
    skeleton = build_skeleton(1.7)
    q = rot.normalise(rng.normal(size=(22, 4)))
    turn, shift = rot.normalise(rng.normal(size=4)), rng.normal(size=3)
    moved = q.copy()
    moved[0] = rot.multiply(turn, q[0])
    before = forward_kinematics(skeleton, np.zeros(3), q)
    after = forward_kinematics(skeleton, shift, moved)
    np.testing.assert_allclose(
        after.positions_m, shift + rot.rotate(turn, before.positions_m), atol=1e-12
    )


def test_head_is_a_sphere_and_capsules_start_at_their_joints(rng: np.random.Generator) -> None:
    """The head's capsule has no length; every other capsule starts at its joint."""
    skeleton = build_skeleton(1.7)
    world = forward_kinematics(skeleton, np.zeros(3), rot.normalise(rng.normal(size=(22, 4))))
    segments = body_part_segments(skeleton, world)
    assert segments.axes_m.shape == (22, 2, 3)
    assert segments.radii_m.shape == (22,)
    head = JOINT_INDEX["Head"]
    np.testing.assert_array_equal(segments.axes_m[head, 0], segments.axes_m[head, 1])
    others = [joint for joint in range(22) if joint != head]
    np.testing.assert_allclose(segments.axes_m[others, 0], world.positions_m[others])


@pytest.mark.parametrize("stature_m", [175.0, 0.0, float("nan"), -1.7])
def test_impossible_stature_is_rejected(stature_m: float) -> None:
    """A stature in centimetres, or that is not a number, raises an error with what is valid."""
    with pytest.raises(SkeletonError, match="in metres"):
        build_skeleton(stature_m)


def test_arrays_of_different_frame_counts_are_rejected() -> None:
    """Rotations and root positions with different frame counts are rejected."""
    with pytest.raises(SkeletonError, match="do not fit"):
        forward_kinematics(build_skeleton(1.7), np.zeros((4, 3)), rot.identity(5, 22))


def test_measured_arms_move_elbows_and_wrists_alone() -> None:
    """An upper arm and a forearm have their measured lengths; every other bone stays usual."""
    usual = build_skeleton(1.7)
    built = build_skeleton(1.7, {"upper_arm": 0.35, "forearm": 0.2, "hand": 0.3})
    for side in ("Left", "Right"):
        assert built.length_m(f"{side}LowerArm") == pytest.approx(0.35, abs=1e-12)
        assert built.length_m(f"{side}Hand") == pytest.approx(0.2, abs=1e-12)
    moved = {"LeftLowerArm", "RightLowerArm", "LeftHand", "RightHand"}
    same = [at for at, name in enumerate(JOINT_NAMES) if name not in moved]
    np.testing.assert_array_equal(built.offsets_m[same], usual.offsets_m[same])
    upper = JOINT_INDEX["LeftUpperArm"]
    np.testing.assert_array_equal(built.capsule_ends_m[upper], built.ends_m[upper])
    np.testing.assert_allclose(built.ends_m[upper], [-0.35, 0.0, 0.0], atol=1e-12)


def test_an_arm_in_centimetres_is_refused() -> None:
    """A length that fits no body names the segment, and asks for metres."""
    with pytest.raises(SkeletonError, match=r"A forearm of .* in metres"):
        build_skeleton(1.7, {"forearm": 24.0})
