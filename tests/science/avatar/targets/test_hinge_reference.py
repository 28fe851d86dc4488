"""Tests of a physics avatar's reference motion: the part of the pose its hinges can follow."""

import math
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from app.science.avatar.body.parts import AXES_OF, AXIS_NAMES, PART_NAMES
from app.science.avatar.configuration.axis_settings import AxisSettings
from app.science.avatar.configuration.editing import lock
from app.science.avatar.configuration.limits import ANATOMIC, FREE
from app.science.avatar.mjcf.gains import default_configuration
from app.science.avatar.targets.hinge_reference import GAP_S, HingeReference
from app.science.avatar.targets.targets import TargetAngles, joint_rotations
from app.science.joint_error.errors import ERROR_JOINTS, joint_error_summary
from app.science.joint_error.recorded import Recorded, ReferenceMotion, recorded_errors
from app.science.rotations import FloatArray, from_rotation_vector, geodesic_angle, identity
from app.science.skeleton.joints import JOINT_COUNT, JOINT_INDEX, JOINT_NAMES
from tests.science.avatar.captured import WALK, captured
from tests.science.avatar.simulated import follow, model
from tests.science.avatar.targets.test_batch import FRAMES, wild_movement

RATE_HZ = 90.0


def _times_s(frames: int) -> FloatArray:
    return np.arange(frames) / RATE_HZ


def _clipped(reference_motion: ReferenceMotion) -> npt.NDArray[np.bool_]:
    assert reference_motion.clipping is not None
    return reference_motion.clipping.clipped


def _shrugging() -> FloatArray:
    """Return two seconds in which shoulders rise by 20 deg and elbows and knees bend askew."""
    poses = identity(180, JOINT_COUNT)
    swing = np.sin(np.linspace(0.0, math.pi, 180))
    for joint, axis, size in (
        ("LeftShoulder", (0.0, 0.0, -1.0), 20.0),
        ("LeftLowerArm", (0.0, -math.cos(0.5), math.sin(0.5)), 60.0),
        ("LeftLowerLeg", (-math.cos(0.5), 0.0, math.sin(0.5)), 60.0),
    ):
        vectors = math.radians(size) * swing[:, np.newaxis] * np.array(axis)
        poses[:, JOINT_INDEX[joint]] = from_rotation_vector(vectors)
    return poses


def test_an_avatar_that_follows_its_command_has_no_error() -> None:
    """An avatar exactly at its command has no error, though raw rotations differ by 20 deg."""
    poses = _shrugging()
    targets = TargetAngles(ANATOMIC).batch(poses)
    actual = joint_rotations(targets.unclamped_rad, poses[:, 0])
    reference_motion = HingeReference(ANATOMIC).recording(_times_s(len(poses)), poses)
    summary = joint_error_summary(reference_motion.rotations, actual, reference_motion.clipping)
    np.testing.assert_allclose(np.nan_to_num(summary.max_rad), 0.0, atol=1e-12)
    raw = joint_error_summary(poses, actual)
    for joint in ("LeftShoulder", "LeftUpperArm", "LeftUpperLeg"):
        assert math.degrees(raw.max_rad[ERROR_JOINTS.index(joint), 0]) > 19.0


def test_a_joint_without_a_hinge_has_no_figures() -> None:
    """A joint without a hinge has no error and no samples, and none count as left out."""
    poses = wild_movement(50)
    parts = [part for part in PART_NAMES if part != "Chest"]
    reference_motion = HingeReference(ANATOMIC, parts).recording(_times_s(50), poses)
    summary = joint_error_summary(reference_motion.rotations, poses, reference_motion.clipping)
    none = {joint for joint, count in zip(ERROR_JOINTS, summary.count, strict=True) if not count}
    assert none == {"LeftShoulder", "RightShoulder", "Chest"}
    rows = [ERROR_JOINTS.index(joint) for joint in none]
    assert np.isnan(summary.rms_rad[rows]).all()
    assert np.isnan(summary.clipped_share[rows]).all()
    assert not summary.left_out.any()


def test_clipped_shares_exist_only_for_free_hinges() -> None:
    """Only free hinges have a clipped share: two of a knee, one of a toe, none of a locked leg."""
    poses = wild_movement(50)
    cast = lock(default_configuration(), "left_leg")

    def shares(reference: HingeReference, joint: str) -> list[bool]:
        reference_motion = reference.recording(_times_s(50), poses)
        summary = joint_error_summary(reference_motion.rotations, poses, reference_motion.clipping)
        return [not math.isnan(one) for one in summary.clipped_share[ERROR_JOINTS.index(joint)]]

    for limits, joint, expected in (
        (ANATOMIC, "LeftLowerLeg", [True, True, True, False]),
        (ANATOMIC, "LeftLowerArm", [True, True, True, False]),
        (FREE, "LeftLowerArm", [True, True, True, True]),
        (ANATOMIC, "RightToes", [True, True, False, False]),
        (cast.in_force, "LeftLowerLeg", [False] * 4),
        (cast.in_force, "RightLowerLeg", [True, True, True, False]),
    ):
        assert shares(HingeReference(limits), joint) == expected, joint


def test_a_locked_limb_has_the_error_of_the_movement_it_misses() -> None:
    """A locked straight knee has an error of 40 deg while the participant bends theirs by 40."""
    cast = lock(default_configuration(), "left_leg")
    angles = np.zeros((20, len(AXIS_NAMES)))
    angles[:, AXIS_NAMES.index("LeftLowerLegX")] = math.radians(40.0)
    poses = joint_rotations(angles, identity(20))
    reference_motion = HingeReference(cast.in_force, cast.parts).recording(_times_s(20), poses)
    summary = joint_error_summary(
        reference_motion.rotations, identity(20, JOINT_COUNT), reference_motion.clipping
    )
    knee = ERROR_JOINTS.index("LeftLowerLeg")
    assert math.degrees(summary.mean_rad[knee, 0]) == pytest.approx(40.0, abs=1e-6)


@pytest.mark.parametrize("broken", [np.nan, 0.0, 0.7])
def test_an_invalid_rotation_makes_only_dependent_joints_unknown(broken: float) -> None:
    """An invalid hand rotation makes hand and forearm unknown in that frame, and nothing else."""
    poses = wild_movement(30)
    poses[10, JOINT_INDEX["RightHand"]] = broken
    reference_motion = HingeReference(ANATOMIC).recording(_times_s(30), poses)
    unknown = np.argwhere(np.isnan(reference_motion.rotations).any(axis=-1))
    assert {(frame, JOINT_NAMES[joint]) for frame, joint in unknown.tolist()} == {
        (10, "RightHand"),
        (10, "RightLowerArm"),
    }


@pytest.mark.parametrize("jump_s", [2.0 * GAP_S, -1.0])
def test_hinges_restart_after_a_gap(jump_s: float) -> None:
    """After a gap or a time that goes back, the hinge angles do not depend on earlier frames."""
    poses, times_s, gap = wild_movement(), _times_s(FRAMES), 700
    late_s = np.where(np.arange(FRAMES) < gap, times_s, times_s + jump_s)
    reference = HingeReference(ANATOMIC)
    cut, apart = reference.recording(late_s, poses), reference.recording(times_s[gap:], poses[gap:])
    np.testing.assert_array_equal(_clipped(cut)[gap:], _clipped(apart))
    together = reference.recording(times_s, poses)
    assert not np.array_equal(_clipped(cut), _clipped(together))


def test_one_pose_has_the_reference_of_a_recording_of_it() -> None:
    """A live pose has the same reference as a recording of it; joints without a hinge have none."""
    poses = wild_movement(20)
    reference = HingeReference(ANATOMIC)
    for pose in poses:
        live = reference.pose(pose)
        stored = reference.recording(np.zeros(1), pose[np.newaxis]).rotations[0]
        hinged = [not JOINT_INDEX[name] or bool(AXES_OF[name]) for name in JOINT_NAMES]
        np.testing.assert_array_equal(live[hinged], stored[hinged])
        assert np.isnan(live[[not one for one in hinged]]).all()
        assert geodesic_angle(live[0], pose[0]) < 1e-12


def test_a_real_walk_has_a_small_error_against_its_command(shared_data: Path) -> None:
    """At 125 ms the error is below 1.5 deg against the command, above 5 against raw rotations."""
    movement = captured(shared_data, WALK)
    built = model()
    followed = follow(built, movement, delay_s=0.125)
    times_s, frames = _times_s(movement.frame_count), np.arange(45, movement.frame_count)

    def mean_deg(reference_motion: ReferenceMotion) -> float:
        run = Recorded(
            times_s, reference_motion, frames, times_s[frames], followed.rotations[frames]
        )
        summary = recorded_errors([run], 0.125).command
        return float(np.degrees(np.nanmean(summary.mean_rad[:, 0])))

    reference = HingeReference(built.configuration.in_force, built.body.parts)
    assert mean_deg(reference.recording(times_s, movement.rotations)) < 1.5
    assert mean_deg(ReferenceMotion(movement.rotations)) > 5.0


def test_a_recording_without_frames_has_an_empty_reference() -> None:
    """A run of which every target frame was lost has an empty reference."""
    reference_motion = HingeReference(ANATOMIC).recording(
        np.zeros(0), np.zeros((0, JOINT_COUNT, 4))
    )
    assert reference_motion.rotations.shape == (0, JOINT_COUNT, 4)
    assert _clipped(reference_motion).shape == (0, len(ERROR_JOINTS), 3)


def test_limits_may_be_settings() -> None:
    """The limits may be given as the axis settings of a configuration."""
    settings = default_configuration().in_force
    assert all(isinstance(one, AxisSettings) for one in settings.values())
    poses = wild_movement(5)
    reference_motion = HingeReference(settings).recording(_times_s(5), poses)
    expected = HingeReference(ANATOMIC).recording(_times_s(5), poses)
    np.testing.assert_allclose(reference_motion.rotations, expected.rotations, atol=1e-9)
