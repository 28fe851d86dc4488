"""Tests of the course of a joint error over active time."""

import numpy as np
import pytest

from app.science.joint_error.course import COURSE_BIN_S, CourseError, joint_error_course
from app.science.rotations import FloatArray

RATE_HZ = 90.0
JOINTS = 21
BIN_FRAMES = round(COURSE_BIN_S * RATE_HZ)


def _times(duration_s: float) -> FloatArray:
    return np.arange(round(duration_s * RATE_HZ)) / RATE_HZ


def test_the_mean_of_the_bins_is_the_mean_of_the_phase() -> None:
    """The sample-weighted mean of the bins is the phase's mean to 1e-12, whatever is missing."""
    rng = np.random.default_rng(5)
    active_s = _times(33.0)
    angles_rad = rng.uniform(0.0, np.pi, (len(active_s), JOINTS))
    angles_rad[rng.random(angles_rad.shape) < 0.2] = np.nan
    angles_rad[:, 4] = np.nan
    course = joint_error_course(angles_rad, active_s, 33.0)
    assert len(course.samples) == 7
    assert course.samples.sum() == np.isfinite(angles_rad).sum()
    whole = np.average(course.mean_rad, weights=course.samples)
    assert whole == pytest.approx(np.nanmean(angles_rad), abs=1e-12)


def test_an_error_that_grows_evenly_grows_evenly_from_bin_to_bin() -> None:
    """For a linearly growing error each bin's mean is the value at the middle of its frames."""
    active_s = _times(20.0)
    angles_rad = np.repeat(0.01 * active_s[:, np.newaxis], JOINTS, axis=1)
    course = joint_error_course(angles_rad, active_s, 20.0)
    middles_s = (np.arange(4) * BIN_FRAMES + 0.5 * (BIN_FRAMES - 1)) / RATE_HZ
    np.testing.assert_allclose(course.mean_rad, 0.01 * middles_s, rtol=1e-12)
    assert course.samples.tolist() == [BIN_FRAMES * JOINTS] * 4


def test_a_bin_without_a_sample_has_no_mean_and_keeps_its_place() -> None:
    """A bin without samples, here from 5 to 10 s, is kept without a mean."""
    active_s = _times(15.0)
    present = (active_s < 5.0) | (active_s >= 10.0)
    angles_rad = np.full((int(present.sum()), 2), 0.5)
    course = joint_error_course(angles_rad, active_s[present], 15.0)
    np.testing.assert_array_equal(course.mean_rad, [0.5, np.nan, 0.5])
    assert course.samples.tolist() == [2 * BIN_FRAMES, 0, 2 * BIN_FRAMES]


def test_frames_after_the_end_of_the_phase_belong_to_its_last_bin() -> None:
    """Frames after the end of the phase count in its last bin, so none are lost."""
    active_s = np.array([0.0, 9.99, 10.004, 3e7])
    course = joint_error_course(np.array([[0.1], [0.2], [0.3], [0.4]]), active_s, 10.0 + 1e-9)
    assert course.samples.tolist() == [1, 3]
    np.testing.assert_allclose(course.mean_rad, [0.1, 0.3])


def test_no_frames_have_no_course_and_shapes_must_fit() -> None:
    """Without frames there are no bins; arrays that differ in length raise an error."""
    assert joint_error_course(np.empty((0, 2)), np.empty(0), 60.0).samples.tolist() == []
    with pytest.raises(CourseError, match=r"\(3, 2\) and active times \(4,\)"):
        joint_error_course(np.zeros((3, 2)), np.zeros(4), 60.0)
