"""Tests of transferring movement between any two bodies, compiled and on plain arrays."""

import numpy as np
import pytest

from app.science.retargeting.t_pose import t_pose
from app.science.retargeting.transfer import Retargeter
from app.science.rig import Rig, RigError, RigMotion, to_local
from app.science.rotations import (
    FloatArray,
    conjugate,
    geodesic_angle,
    identity,
    multiply,
    rotate,
)
from tests.science.retargeting.bodies import (
    SAME,
    own_body,
    random_body,
    random_movement,
    scaled,
    turned,
)

FEET = ("LeftFoot", "LeftToes", "RightFoot", "RightToes")
LIMBS = (
    ("Neck", "Head"),
    ("LeftUpperArm", "LeftLowerArm"),
    ("RightLowerArm", "RightHand"),
    ("LeftUpperLeg", "LeftLowerLeg"),
    ("RightLowerLeg", "RightFoot"),
)


@pytest.fixture
def rng() -> np.random.Generator:
    """Return random numbers with a fixed seed."""
    return np.random.default_rng(6)


def _plain(
    motion: RigMotion, source_map: dict[str, str], avatar: Rig, avatar_map: dict[str, str]
) -> FloatArray:
    """Return the avatar's world rotations by the equations, joint by joint on whole arrays."""
    theirs, ours = t_pose(motion.rig, source_map), t_pose(avatar, avatar_map)
    world = motion.world()[1]
    turn = multiply(theirs.facing, conjugate(ours.facing))
    body_of = {avatar_map[name]: name for name in avatar_map if name in source_map}
    result = np.empty((motion.frame_count, avatar.joint_count, 4))
    for joint, parent in enumerate(avatar.parents):
        if avatar.names[joint] in body_of:
            mover = motion.rig.index(source_map[body_of[avatar.names[joint]]])
            since = multiply(world[:, mover], conjugate(theirs.world_rotations[mover]))
            aligned = multiply(turn, ours.world_rotations[joint])
            result[:, joint] = multiply(since, aligned)
        elif parent < 0:
            result[:, joint] = ours.local_rotations[joint]
        else:
            result[:, joint] = multiply(result[:, parent], ours.local_rotations[joint])
    return result


def test_compiled_and_plain_agree(rng: np.random.Generator) -> None:
    """The compiled transfer agrees with the equations on plain arrays for random pairs."""
    for _ in range(20):
        source, avatar = random_body(rng), random_body(rng)
        left_out = rng.choice([name for name in SAME if name != "Hips"], 6, replace=False)
        avatar_map = {name: joint for name, joint in SAME.items() if name not in left_out[:3]}
        source_map = {name: joint for name, joint in SAME.items() if name not in left_out[3:]}
        motion = random_movement(source, rng, frames=37)
        result = Retargeter(source, source_map, avatar, avatar_map).batch(motion)
        expected = to_local(avatar, _plain(motion, source_map, avatar, avatar_map))
        assert float(np.max(np.abs(result.rotations - expected))) < 1e-12


def test_single_frames_equal_the_batch(rng: np.random.Generator) -> None:
    """Transferring frame by frame and as a batch gives the same movement to 1e-12."""
    source, avatar = random_body(rng), own_body(1.9)
    motion = random_movement(source, rng, frames=50)
    retargeter = Retargeter(source, SAME, avatar, SAME)
    batch = retargeter.batch(motion)
    offset = retargeter.hips_offset_m(motion.root_positions_m[0], motion.rotations[0])
    for at in range(motion.frame_count):
        root, local = retargeter.frame(
            motion.root_positions_m[at], motion.rotations[at], hips_offset_m=offset
        )
        np.testing.assert_allclose(root, batch.root_positions_m[at], atol=1e-12)
        np.testing.assert_allclose(local, batch.rotations[at], atol=1e-12)


def test_a_body_on_itself_moves_as_it_did(rng: np.random.Generator) -> None:
    """A movement transferred to the same body is unchanged to 1e-12, travel included."""
    for _ in range(10):
        rig = random_body(rng)
        everything = random_movement(rig, rng)
        # Extra joints keep their T-pose, so they must not move here.
        still = [joint for joint, name in enumerate(rig.names) if name not in SAME]
        everything.rotations[:, still] = rig.rest_rotations[still]
        result = Retargeter(rig, SAME, rig, SAME).batch(everything)
        np.testing.assert_allclose(result.rotations, everything.rotations, atol=1e-12)
        travel = result.root_positions_m - everything.root_positions_m
        np.testing.assert_allclose(travel - travel[0], 0.0, atol=1e-12)
        np.testing.assert_allclose(travel[:, [0, 2]], 0.0, atol=1e-12)


@pytest.mark.parametrize("yaw_deg", [90.0, 180.0, -37.0])
def test_turning_the_world_turns_the_result(rng: np.random.Generator, yaw_deg: float) -> None:
    """Turning the source's world turns the result by the same rotation."""
    half = np.radians(yaw_deg) / 2
    turn = np.array((np.cos(half), 0.0, np.sin(half), 0.0))
    source, avatar = random_body(rng), own_body(1.3)
    motion = random_movement(source, rng)
    retargeter = Retargeter(source, SAME, avatar, SAME)
    here, there = retargeter.batch(motion), retargeter.batch(turned(motion, turn))
    expected = turned(here, turn)
    np.testing.assert_allclose(there.rotations, expected.rotations, atol=1e-12)
    np.testing.assert_allclose(there.root_positions_m, expected.root_positions_m, atol=1e-12)


def test_the_way_a_rest_pose_faces_makes_no_difference(rng: np.random.Generator) -> None:
    """A capture whose rest pose faces +z gives the same movement as one that faces -z."""
    half_turn = np.array((0.0, 0.0, 1.0, 0.0))
    body, avatar = own_body(1.7), own_body(1.9)
    back = Rig(body.names, body.parents, rotate(half_turn, body.offsets_m), identity(22))
    motion = random_movement(body, rng)
    # The same movement in the world: each frame counted from the turned rest pose.
    world = multiply(motion.world()[1], conjugate(half_turn))
    same = RigMotion(back, 120.0, motion.root_positions_m, to_local(back, world), motion.observed)
    result = Retargeter(back, SAME, avatar, SAME).batch(same)
    expected = Retargeter(body, SAME, avatar, SAME).batch(motion)
    gap = geodesic_angle(result.rotations, expected.rotations)
    assert float(np.max(gap)) < 1e-12
    np.testing.assert_allclose(result.root_positions_m, expected.root_positions_m, atol=1e-12)


def test_bones_point_where_the_sources_bones_point(rng: np.random.Generator) -> None:
    """In every frame torso, arms and legs of both bodies have the same directions."""
    source, avatar = random_body(rng), random_body(rng)
    motion = random_movement(source, rng)
    for rig in (source, avatar):
        assert {bone.body_joint for bone in t_pose(rig, SAME).bones} >= {"Neck", "LeftUpperLeg"}
    # Extra joints are at rest on both sides, as in the T-pose.
    still = [joint for joint, name in enumerate(source.names) if name not in SAME]
    motion.rotations[:, still] = source.rest_rotations[still]
    result = Retargeter(source, SAME, avatar, SAME).batch(motion)
    for start, end in LIMBS:
        bones = []
        for moved in (motion, result):
            places = moved.world()[0]
            bone = places[:, moved.rig.index(end)] - places[:, moved.rig.index(start)]
            bones.append(bone / np.linalg.norm(bone, axis=-1, keepdims=True))
        np.testing.assert_allclose(bones[0], bones[1], atol=1e-9)


@pytest.mark.parametrize("factor", [0.7, 1.0, 1.4])
def test_a_scaled_copy_takes_scaled_steps_and_does_not_slide(
    rng: np.random.Generator, factor: float
) -> None:
    """On a scaled copy all joints travel the scaled distance to 1e-9, so resting feet stay put.

    The step ratio is the leg ratio.
    """
    source = own_body(1.7)
    avatar = scaled(source, factor)
    motion = random_movement(source, rng)
    retargeter = Retargeter(source, SAME, avatar, SAME)
    assert retargeter.leg_ratio == pytest.approx(factor, abs=1e-12)
    places, result = motion.world()[0], retargeter.batch(motion).world()[0]
    for name in FEET:
        joint = source.index(name)
        steps = np.diff(places[:, joint], axis=0)
        np.testing.assert_allclose(np.diff(result[:, joint], axis=0), factor * steps, atol=1e-9)


def test_motives_t_pose_gives_the_papers_product(rng: np.random.Generator) -> None:
    """For a source whose T-pose is the identity, Q_avatar = Q_capture Q_T in the world."""
    source, avatar = own_body(1.7), random_body(rng)
    motion = random_movement(source, rng)
    result = Retargeter(source, SAME, avatar, SAME).batch(motion)
    ours = t_pose(avatar, SAME)
    captured, moved = motion.world()[1], result.world()[1]
    for name in SAME:
        q_capture, joint = captured[:, source.index(name)], avatar.index(name)
        q_t = multiply(conjugate(ours.facing), ours.world_rotations[joint])
        gap = geodesic_angle(moved[:, joint], multiply(q_capture, q_t))
        assert float(np.max(gap)) < 1e-12


def test_unmapped_joints_are_listed_and_keep_their_t_pose(rng: np.random.Generator) -> None:
    """Unmapped joints are listed and keep their T-pose; unobserved ones stay unobserved."""
    source, avatar = own_body(1.7), random_body(rng)
    avatar_map = {name: joint for name, joint in SAME.items() if name != "Chest"}
    motion = random_movement(source, rng)
    motion.observed[4, source.index("LeftHand")] = False
    retargeter = Retargeter(source, SAME, avatar, avatar_map)
    result = retargeter.batch(motion)
    between = {name for name in avatar.names if name.startswith("between")}
    assert set(retargeter.unmapped_avatar_joints) == {"Chest", *between}
    assert retargeter.unmapped_source_joints == ("Chest",)
    assert "Chest" not in retargeter.carried
    for name in retargeter.unmapped_avatar_joints:
        joint = avatar.index(name)
        rest = retargeter.avatar_t_pose.local_rotations[joint]
        assert float(np.max(geodesic_angle(result.rotations[:, joint], rest))) < 1e-12
    unseen = np.argwhere(~result.observed).tolist()
    assert unseen == [[4, avatar.index("LeftHand")]]


def test_arrays_of_any_layout_give_the_same(rng: np.random.Generator) -> None:
    """Read-only, strided and single-precision arrays give the same result."""
    source = own_body(1.7)
    motion = random_movement(source, rng)
    retargeter = Retargeter(source, SAME, own_body(1.9), SAME)
    root, rotations = motion.root_positions_m[7], motion.rotations[7]
    expected = retargeter.frame(root, rotations)
    frozen = rotations.copy()
    frozen.flags.writeable = False
    strided = np.asfortranarray(rotations)
    for given in (frozen, strided):
        np.testing.assert_array_equal(retargeter.frame(root, given)[1], expected[1])
    single = retargeter.frame(root.astype(np.float32), rotations.astype(np.float32))
    np.testing.assert_allclose(single[1], expected[1], atol=1e-6)


def test_wrong_arrays_are_rejected(rng: np.random.Generator) -> None:
    """A frame of 21 joints and a movement of another skeleton raise different errors."""
    source = own_body(1.7)
    retargeter = Retargeter(source, SAME, own_body(1.9), SAME)
    with pytest.raises(RigError, match=r"\(22, 4\)"):
        retargeter.frame(np.zeros(3), identity(21))
    with pytest.raises(RigError, match="different skeleton"):
        retargeter.batch(random_movement(random_body(rng), rng))
