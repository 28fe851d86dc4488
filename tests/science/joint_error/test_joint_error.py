"""Tests of the joint error between target and actual rotations."""

import numpy as np
import pytest

from app.science import rotations as rot
from app.science.joint_error.errors import (
    ERROR_JOINTS,
    JointErrorError,
    joint_error_summary,
    joint_errors,
)


@pytest.fixture
def rng() -> np.random.Generator:
    """Return random numbers with a fixed seed."""
    return np.random.default_rng(11)


def _random(rng: np.random.Generator, frames: int = 300) -> rot.FloatArray:
    return rot.normalise(rng.normal(size=(frames, 22, 4)))


def test_identical_rotations_have_no_error(rng: np.random.Generator) -> None:
    """Equal rotations have zero error, whichever sign their quaternions have."""
    q = _random(rng)
    summary = joint_error_summary(q, -q)
    np.testing.assert_allclose(summary.max_rad, 0.0, atol=1e-12)
    assert summary.count.tolist() == [300] * 21
    assert summary.left_out.tolist() == [0] * 21


def test_the_angle_does_not_depend_on_the_parents_frame(rng: np.random.Generator) -> None:
    """Turning the parent's frame turns the error vector and keeps its angle."""
    target, actual, turn = _random(rng), _random(rng), rot.normalise(rng.normal(size=4))
    before = joint_errors(target, actual).values_rad
    after = joint_errors(rot.multiply(turn, target), rot.multiply(turn, actual)).values_rad
    np.testing.assert_allclose(after[..., 0], before[..., 0], atol=1e-9)
    np.testing.assert_allclose(after[..., 1:], rot.rotate(turn, before[..., 1:]), atol=1e-7)


def test_exchanging_target_and_actual_turns_the_sign(rng: np.random.Generator) -> None:
    """Exchanging target and actual reverses the sign of the error vector."""
    target, actual = _random(rng), _random(rng)
    there, back = joint_errors(target, actual).values_rad, joint_errors(actual, target).values_rad
    np.testing.assert_allclose(back[..., 1:], -there[..., 1:], atol=1e-9)


def test_a_known_error_is_found_in_the_parents_axes(rng: np.random.Generator) -> None:
    """An extra rotation about the parent's x axis gives an error of +x only."""
    target = _random(rng)
    extra = rot.from_rotation_vector(np.array((np.radians(10.0), 0.0, 0.0)))
    actual = target.copy()
    actual[:, 5] = rot.multiply(extra, target[:, 5])
    summary = joint_error_summary(target, actual)
    head = ERROR_JOINTS.index("Head")
    expected = np.radians((10.0, 10.0, 0.0, 0.0))
    for table in (summary.mean_rad, summary.rms_rad, summary.p95_rad, summary.max_rad):
        np.testing.assert_allclose(table[head], expected, atol=1e-9)
        np.testing.assert_allclose(np.delete(table, head, axis=0), 0.0, atol=1e-9)


def test_summary_follows_its_definitions() -> None:
    """The mean is signed; rms, 95th percentile and maximum are of absolute values."""
    angles = np.radians(np.linspace(-10.0, 20.0, 101))
    vectors = np.zeros((101, 22, 3))
    vectors[:, 3, 2] = angles
    summary = joint_error_summary(rot.identity(101, 22), rot.from_rotation_vector(vectors))
    joint = 2
    expected = (
        angles.mean(),
        np.sqrt((angles**2).mean()),
        np.percentile(np.abs(angles), 95),
        np.radians(20.0),
    )
    tables = (summary.mean_rad, summary.rms_rad, summary.p95_rad, summary.max_rad)
    np.testing.assert_allclose([table[joint, 3] for table in tables], expected, atol=1e-12)
    assert summary.mean_rad[joint, 0] == pytest.approx(np.abs(angles).mean())


def test_the_hips_have_no_error(rng: np.random.Generator) -> None:
    """Rotations of the hips do not change the error of any joint."""
    target = _random(rng)
    actual = target.copy()
    actual[:, 0] = rot.normalise(rng.normal(size=(300, 4)))
    assert "Hips" not in ERROR_JOINTS
    np.testing.assert_allclose(joint_error_summary(target, actual).max_rad, 0.0, atol=1e-12)


def test_bad_samples_are_left_out_and_counted(rng: np.random.Generator) -> None:
    """Non-finite and non-unit samples count as left out and change no other number."""
    target = _random(rng)
    actual = rot.multiply(rot.from_rotation_vector(np.array((0.0, 0.2, 0.0))), target)
    actual[3, 4], actual[7, 4], target[9, 4] = np.nan, 2.0 * actual[7, 4], 0.0
    actual[:, 6] = np.inf
    summary = joint_error_summary(target, actual)
    neck, left_shoulder = ERROR_JOINTS.index("Neck"), ERROR_JOINTS.index("LeftShoulder")
    assert summary.left_out[neck] == 3
    assert summary.count[neck] == 297
    assert summary.left_out[left_shoulder] == 300
    assert np.isnan(summary.mean_rad[left_shoulder]).all()
    np.testing.assert_allclose(np.delete(summary.max_rad[:, 0], left_shoulder), 0.2)


@pytest.mark.parametrize("shape", [(5, 22, 4), (4, 21, 4), (22, 4)])
def test_recordings_of_different_shapes_are_rejected(shape: tuple[int, ...]) -> None:
    """Recordings that are not (N, 22, 4) or differ in length are rejected."""
    with pytest.raises(JointErrorError, match="do not fit"):
        joint_error_summary(np.zeros((4, 22, 4)), np.zeros(shape))
