"""Captures on our skeleton, and movement without end."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from app.adapters.bvh import BvhClip, read_bvh
from app.science import rotations as rot
from app.science.skeleton import (
    JOINT_INDEX,
    JOINT_NAMES,
    PARENTS,
    Movement,
    SkeletonError,
    build_skeleton,
    forward_kinematics,
    largest_step_rad,
    loop,
    resample,
    retarget,
)

_OWN_NAMES = {name: name for name in JOINT_NAMES}


@dataclass(frozen=True, eq=False)
class _OwnCapture:
    """A capture made on our own skeleton, in its T-pose and axes."""

    offsets_m: rot.FloatArray
    root_m: rot.FloatArray
    local: rot.FloatArray
    names: tuple[str, ...] = JOINT_NAMES
    parents: tuple[int, ...] = PARENTS
    frame_time_s: float = 1 / 120

    def world(self) -> tuple[rot.FloatArray, rot.FloatArray]:
        """Places and rotations by forward kinematics."""
        world = forward_kinematics(build_skeleton(1.75), self.root_m, self.local)
        return world.positions_m, world.rotations


@pytest.fixture
def rng() -> np.random.Generator:
    """Return random numbers with a fixed seed."""
    return np.random.default_rng(3)


def _walk(shared_data: Path, name: str = "02_01") -> BvhClip:
    path = shared_data / "motion" / "cmu_bvh" / f"{name}.bvh"
    return read_bvh(path, metres_per_unit=0.056444)


def _swaying(rng: np.random.Generator, frames: int = 360) -> Movement:
    """Return a slow movement of all joints but the hips, feet flat and hips still."""
    times = np.arange(frames) / 120.0
    vectors = 0.3 * rng.normal(size=(22, 3)) * np.sin(times)[:, np.newaxis, np.newaxis]
    vectors[:, 0] = 0.0
    vectors[:, 14:] = 0.0
    root = np.tile(build_skeleton(1.75).offsets_m[0], (frames, 1))
    return Movement(120.0, root, rot.from_rotation_vector(vectors))


def test_a_capture_of_our_own_skeleton_comes_back_unchanged(rng: np.random.Generator) -> None:
    """Where rest pose, axes and size agree, retargeting is the identity."""
    skeleton, movement = build_skeleton(1.75), _swaying(rng)
    clip = _OwnCapture(skeleton.offsets_m, movement.root_positions_m, movement.rotations)
    result = retarget(clip, skeleton, _OWN_NAMES)
    assert float(np.max(rot.geodesic_angle(result.rotations, movement.rotations))) < 1e-6
    np.testing.assert_allclose(
        result.root_positions_m[:, 1], movement.root_positions_m[:, 1], atol=1e-9
    )


@pytest.mark.parametrize("angle_deg", [0.0, 90.0, 180.0, -37.0])
def test_the_way_a_capture_faces_makes_no_difference(
    rng: np.random.Generator, angle_deg: float
) -> None:
    """A person who walked another way gives the same movement, facing -z."""
    skeleton, movement = build_skeleton(1.75), _swaying(rng)
    turn = rot.from_rotation_vector(np.array((0.0, np.radians(angle_deg), 0.0)))
    local = movement.rotations.copy()
    local[:, 0] = rot.multiply(turn, local[:, 0])
    clip = _OwnCapture(skeleton.offsets_m, movement.root_positions_m, local)
    result = retarget(clip, skeleton, _OWN_NAMES)
    assert float(np.max(rot.geodesic_angle(result.rotations, movement.rotations))) < 1e-6


@pytest.mark.parametrize("name", ["02_01", "06_01", "12_02"])
def test_bones_point_where_the_captures_bones_point(shared_data: Path, name: str) -> None:
    """A shank has the same angle to the vertical as in the capture."""
    skeleton, clip = build_skeleton(1.75), _walk(shared_data, name)
    movement = retarget(clip, skeleton)
    ours = forward_kinematics(skeleton, movement.root_positions_m, movement.rotations).positions_m
    theirs = clip.world()[0][-movement.frame_count :]
    for upper, lower, a, b in (
        ("LeftLowerLeg", "LeftFoot", "LeftLeg", "LeftFoot"),
        ("RightUpperArm", "RightLowerArm", "RightArm", "RightForeArm"),
    ):
        bone = ours[:, JOINT_INDEX[lower]] - ours[:, JOINT_INDEX[upper]]
        source = theirs[:, clip.names.index(b)] - theirs[:, clip.names.index(a)]
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
    movement = retarget(_walk(shared_data, name), skeleton)
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
    """The seam and the cross-fade add no jump: at most a tenth over the clip's own largest step."""
    clip = resample(retarget(_walk(shared_data, name), build_skeleton(1.75)), 90.0)
    looped = loop(clip)
    assert looped.loops
    assert 0.5 * clip.duration_s - 0.5 <= looped.duration_s < clip.duration_s
    assert largest_step_rad(looped) <= 1.1 * largest_step_rad(clip)
    root = np.concatenate((looped.root_positions_m, looped.root_positions_m[:1]))
    original = np.abs(np.diff(clip.root_positions_m, axis=0)).max()
    assert float(np.abs(np.diff(root, axis=0)).max()) <= 1.5 * float(original)


def test_resampling_keeps_duration_and_path(rng: np.random.Generator) -> None:
    """At 90 Hz the movement lasts as long and passes through the same rotations."""
    movement = _swaying(rng, frames=361)
    again = resample(movement, 90.0)
    assert again.duration_s == pytest.approx(movement.duration_s)
    # Every third frame at 90 Hz coincides with every fourth at 120 Hz.
    angle = rot.geodesic_angle(again.rotations[::3], movement.rotations[::4])
    assert float(np.max(angle)) < 1e-7
    assert rot.is_unit(again.rotations, 1e-12).all()


def test_a_capture_without_our_joints_is_refused(shared_data: Path) -> None:
    """A missing joint is named."""
    path = shared_data / "motion" / "bvh_toolbox" / "walk01.bvh"
    with pytest.raises(SkeletonError, match="no joint for Spine"):
        retarget(read_bvh(path, metres_per_unit=0.01), build_skeleton(1.75))


def test_movement_that_cannot_be_looped_or_resampled_is_refused(rng: np.random.Generator) -> None:
    """Too short clips, doubled loops and impossible rates are refused."""
    movement = _swaying(rng)
    with pytest.raises(SkeletonError, match="cannot be looped"):
        loop(_swaying(rng, frames=60))
    with pytest.raises(SkeletonError, match="cannot be looped"):
        loop(loop(movement))
    with pytest.raises(SkeletonError, match="not valid"):
        resample(movement, 0.0)
    with pytest.raises(SkeletonError, match="resample first"):
        resample(loop(movement), 90.0)
