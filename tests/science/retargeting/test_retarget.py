"""Tests of captures on the product's skeleton: moving in place, resampled and looped."""

from pathlib import Path

import numpy as np
import pytest

from app.adapters.captures.reader import read_capture_file
from app.science import rotations as rot
from app.science.retargeting.in_place import movement_in_place
from app.science.retargeting.joint_map import JointMapError
from app.science.retargeting.reference_avatars import REFERENCE_JOINT_MAP, reference_avatar
from app.science.rig import RigMotion
from app.science.skeleton import (
    JOINT_INDEX,
    Movement,
    SkeletonError,
    build_skeleton,
    forward_kinematics,
    largest_step_rad,
    loop,
    resample,
)
from app.simulated_people.body import UnusableCapture, captured_movement, make_person


def _own_capture(movement: Movement) -> RigMotion:
    """Return a capture on the product's own skeleton, in its T-pose and axes."""
    observed = np.ones(movement.rotations.shape[:2], dtype=np.bool_)
    return RigMotion(
        reference_avatar(1.75), 120.0, movement.root_positions_m, movement.rotations, observed
    )


@pytest.fixture
def rng() -> np.random.Generator:
    """Return random numbers with a fixed seed."""
    return np.random.default_rng(3)


def _walk(shared_data: Path, name: str = "02_01") -> Path:
    return shared_data / "motion" / "cmu_bvh" / f"{name}.bvh"


def _swaying(rng: np.random.Generator, frames: int = 360) -> Movement:
    """Return a slow movement of all joints except for the hips, with flat feet."""
    times = np.arange(frames) / 120.0
    vectors = 0.3 * rng.normal(size=(22, 3)) * np.sin(times)[:, np.newaxis, np.newaxis]
    vectors[:, 0] = 0.0
    vectors[:, 14:] = 0.0
    root = np.tile(build_skeleton(1.75).offsets_m[0], (frames, 1))
    return Movement(120.0, root, rot.from_rotation_vector(vectors))


def test_a_capture_of_our_own_skeleton_comes_back_unchanged(rng: np.random.Generator) -> None:
    """A capture of the product's own skeleton is unchanged by retargeting."""
    skeleton, movement = build_skeleton(1.75), _swaying(rng)
    result = movement_in_place(_own_capture(movement), REFERENCE_JOINT_MAP, skeleton)
    assert float(np.max(rot.geodesic_angle(result.rotations, movement.rotations))) < 1e-6
    np.testing.assert_allclose(
        result.root_positions_m[:, 1], movement.root_positions_m[:, 1], atol=1e-9
    )


@pytest.mark.parametrize("angle_deg", [0.0, 90.0, 180.0, -37.0])
def test_the_way_a_capture_faces_makes_no_difference(
    rng: np.random.Generator, angle_deg: float
) -> None:
    """A capture that faces another way gives the same movement, facing -z."""
    skeleton, movement = build_skeleton(1.75), _swaying(rng)
    turn = rot.from_rotation_vector(np.array((0.0, np.radians(angle_deg), 0.0)))
    local = movement.rotations.copy()
    local[:, 0] = rot.multiply(turn, local[:, 0])
    turned = Movement(120.0, movement.root_positions_m, local)
    result = movement_in_place(_own_capture(turned), REFERENCE_JOINT_MAP, skeleton)
    assert float(np.max(rot.geodesic_angle(result.rotations, movement.rotations))) < 1e-6


@pytest.mark.parametrize("name", ["02_01", "06_01", "12_02"])
def test_bones_point_where_the_captures_bones_point(shared_data: Path, name: str) -> None:
    """Bones have the same angles to the vertical as in the capture."""
    skeleton, path = build_skeleton(1.75), _walk(shared_data, name)
    clip = read_capture_file(path).motion
    assert isinstance(clip, RigMotion)
    movement = captured_movement(path, skeleton)
    ours = forward_kinematics(skeleton, movement.root_positions_m, movement.rotations).positions_m
    theirs = clip.world()[0][-movement.frame_count :]
    for upper, lower, a, b in (
        ("LeftLowerLeg", "LeftFoot", "LeftLeg", "LeftFoot"),
        ("RightUpperArm", "RightLowerArm", "RightArm", "RightForeArm"),
    ):
        bone = ours[:, JOINT_INDEX[lower]] - ours[:, JOINT_INDEX[upper]]
        source = theirs[:, clip.rig.index(b)] - theirs[:, clip.rig.index(a)]
        np.testing.assert_allclose(
            bone[:, 1] / np.linalg.norm(bone, axis=1),
            source[:, 1] / np.linalg.norm(source, axis=1),
            atol=1e-6,
        )


@pytest.mark.parametrize("name", ["02_01", "06_01", "12_02"])
@pytest.mark.parametrize("stature_m", [1.5, 1.9])
def test_a_walk_stays_in_place_on_the_floor(shared_data: Path, name: str, stature_m: float) -> None:
    """A walk of metres becomes one in place: upright, feet on the floor, facing -z."""
    skeleton = build_skeleton(stature_m)
    movement = captured_movement(_walk(shared_data, name), skeleton)
    world = forward_kinematics(skeleton, movement.root_positions_m, movement.rotations)
    assert float(np.abs(movement.root_positions_m[:, [0, 2]]).max()) < 0.12
    head = world.positions_m[:, JOINT_INDEX["Head"], 1]
    assert 0.8 * stature_m < float(head.min()) <= float(head.max()) < 0.95 * stature_m
    ankles = world.positions_m[:, [JOINT_INDEX["LeftFoot"], JOINT_INDEX["RightFoot"]], 1]
    assert float(ankles.min()) == pytest.approx(skeleton.ankle_height_m, abs=0.02)
    forward = rot.rotate(movement.rotations[:, 0], np.array((0.0, 0.0, -1.0)))
    assert float(forward[:, 2].max()) < -0.9


@pytest.mark.parametrize("name", ["02_01", "06_01", "12_02"])
def test_a_loop_steps_no_further_than_its_clip(shared_data: Path, name: str) -> None:
    """At a loop's seam no joint moves more than a tenth further than in the clip itself."""
    clip = resample(captured_movement(_walk(shared_data, name), build_skeleton(1.75)), 90.0)
    looped = loop(clip)
    assert looped.loops
    assert 0.5 * clip.duration_s - 0.5 <= looped.duration_s < clip.duration_s
    assert largest_step_rad(looped) <= 1.1 * largest_step_rad(clip)
    root = np.concatenate((looped.root_positions_m, looped.root_positions_m[:1]))
    original = np.abs(np.diff(clip.root_positions_m, axis=0)).max()
    assert float(np.abs(np.diff(root, axis=0)).max()) <= 1.5 * float(original)


def test_resampling_keeps_duration_and_path(rng: np.random.Generator) -> None:
    """A movement resampled to 90 Hz keeps its duration and passes through the same rotations."""
    movement = _swaying(rng, frames=361)
    resampled = resample(movement, 90.0)
    assert resampled.duration_s == pytest.approx(movement.duration_s)
    # Every third frame at 90 Hz coincides with every fourth at 120 Hz.
    angle = rot.geodesic_angle(resampled.rotations[::3], movement.rotations[::4])
    assert float(np.max(angle)) < 1e-7
    assert rot.is_unit(resampled.rotations, 1e-12).all()


def test_a_map_that_does_not_fit_is_rejected(rng: np.random.Generator) -> None:
    """A joint map with a joint that the capture lacks raises an error that names it."""
    with pytest.raises(JointMapError, match="no joint 'Bauch'"):
        movement_in_place(
            _own_capture(_swaying(rng)), {"Hips": "Hips", "Spine": "Bauch"}, build_skeleton(1.75)
        )


def test_movement_that_cannot_be_looped_or_resampled_is_rejected(rng: np.random.Generator) -> None:
    """Clips that are too short, loops of loops and impossible rates are rejected."""
    movement = _swaying(rng)
    with pytest.raises(SkeletonError, match="cannot be looped"):
        loop(_swaying(rng, frames=60))
    with pytest.raises(SkeletonError, match="cannot be looped"):
        loop(loop(movement))
    with pytest.raises(SkeletonError, match="not valid"):
        resample(movement, 0.0)
    with pytest.raises(SkeletonError, match="resample before looping"):
        resample(loop(movement), 90.0)


def test_legs_that_were_not_captured_stand(shared_data: Path) -> None:
    """A person captured without legs stands on straight legs and still moves the arms."""
    skeleton = build_skeleton(1.72)
    path = shared_data / "motion" / "vicon_tracker" / "ObjectInspection_0.csv"
    movement = captured_movement(path, skeleton)
    world = forward_kinematics(skeleton, movement.root_positions_m, movement.rotations)
    ankles = world.positions_m[:, [JOINT_INDEX["LeftFoot"], JOINT_INDEX["RightFoot"]], 1]
    assert float(np.abs(ankles.min(axis=1) - skeleton.ankle_height_m).max()) < 1e-3
    assert float(ankles.max()) < skeleton.ankle_height_m + 0.1
    hands = world.positions_m[:, JOINT_INDEX["RightHand"]]
    assert float(np.ptp(hands, axis=0).max()) > 0.5


@pytest.mark.parametrize(
    "file",
    [
        "bvh_toolbox/walk01.bvh",
        "c3d/Gait.c3d",
        "cmu_asfamc/02_01.amc",
        "cmu_c3d/02_01.c3d",
        "trc/walk.trc",
        "vicon_tracker/HumanRobotHandover_0.csv",
    ],
)
def test_any_capture_with_a_body_makes_a_simulated_person(shared_data: Path, file: str) -> None:
    """A capture in any format gives an upright simulated person of the captured stature."""
    person = make_person(np.random.default_rng(5), shared_data / "motion" / file)
    first = person.participant.pose(0.0, None)
    world = forward_kinematics(person.skeleton, first.root_position_m, first.rotations)
    head = float(world.positions_m[JOINT_INDEX["Head"], 1])
    assert 0.8 * person.stature_m < head < 0.95 * person.stature_m


@pytest.mark.parametrize(
    ("file", "why"),
    [
        ("c3d/walkingOptiTrack.c3d", "pelvis"),
        ("optitrack_csv/sample_optitrack_take.csv", "Too few tracked bodies"),
        ("bvh_toolbox/walk01_pos.csv", "captures that can be read"),
    ],
)
def test_a_capture_without_a_body_makes_no_simulated_person(
    shared_data: Path, file: str, why: str
) -> None:
    """A capture without a body raises an error that names the file and states the reason."""
    with pytest.raises(UnusableCapture, match=why):
        make_person(np.random.default_rng(5), shared_data / "motion" / file)
