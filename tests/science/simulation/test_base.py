"""Tests of the background movement that goes on while the limbs do a task."""

import numpy as np

from app.science.rotations import FloatArray
from app.science.simulation import posture_kernels
from tests.science.simulation.people import rng_of


def _unit(rows: FloatArray) -> FloatArray:
    length = np.linalg.norm(rows, axis=-1, keepdims=True)
    return np.asarray(rows / length)


def test_a_pose_between_two_frames_is_the_weighted_mean_of_both() -> None:
    """The mean of two frames, or a share of its distance from a pose at rest, gets length 1."""
    rng = rng_of(3)
    frames, rest = _unit(rng.normal(size=(4, 22, 4))), _unit(rng.normal(size=(22, 4)))
    gains = rng.random(22)
    mean = 0.75 * frames[2] + 0.25 * frames[3]
    np.testing.assert_allclose(
        posture_kernels.between(frames, 2, 0.25), _unit(mean), rtol=0.0, atol=1e-15
    )
    damped = _unit((1.0 - gains)[:, np.newaxis] * rest + gains[:, np.newaxis] * mean)
    found = posture_kernels.between(frames, 2, 0.25, (1.0 - gains)[:, np.newaxis] * rest, gains)
    np.testing.assert_allclose(found, damped, rtol=0.0, atol=1e-15)


def test_at_a_frame_the_pose_is_the_frame() -> None:
    """With the share 0 the pose is the frame itself, and with gains of zero the pose at rest."""
    frames = _unit(rng_of(4).normal(size=(2, 22, 4)))
    np.testing.assert_allclose(posture_kernels.between(frames, 0, 0.0), frames[0], atol=1e-15)
    still = posture_kernels.between(frames, 0, 0.4, frames[1], np.zeros(22))
    np.testing.assert_allclose(still, frames[1], atol=1e-15)
