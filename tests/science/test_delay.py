"""Tests of the delay buffer of the delayed-copy avatar."""

import numpy as np
import pytest

from app.science import rotations as rot
from app.science.delay import DelayBuffer, DelayError, delayed_pose


@pytest.fixture
def rng() -> np.random.Generator:
    """Return random numbers with a fixed seed."""
    return np.random.default_rng(7)


def _movement(rng: np.random.Generator, frames: int = 180) -> tuple[rot.FloatArray, rot.FloatArray]:
    """Return times jittered around a rate of 90 Hz, and smoothly moving rotations."""
    times = np.cumsum(rng.uniform(0.008, 0.014, frames))
    speed = rng.normal(size=(22, 3))
    phase = np.sin(times)[:, np.newaxis, np.newaxis]
    return times, rot.from_rotation_vector(speed * phase)


def test_zero_delay_is_the_same_to_the_bit(rng: np.random.Generator) -> None:
    """Without delay the avatar's rotations are the participant's, bit for bit."""
    times, q = _movement(rng)
    buffer = DelayBuffer(0.0)
    assert delayed_pose(times, q, times, 0.0).tobytes() == q.tobytes()
    assert all(
        buffer.push(t, row).tobytes() == row.tobytes() for t, row in zip(times, q, strict=True)
    )


@pytest.mark.parametrize("delay_s", [0.004, 0.125, 0.35, 1.9])
def test_streaming_equals_the_batch(rng: np.random.Generator, delay_s: float) -> None:
    """Delaying frame by frame and as a batch gives the same avatar."""
    times, q = _movement(rng)
    buffer = DelayBuffer(delay_s)
    streamed = np.stack([buffer.push(t, row) for t, row in zip(times, q, strict=True)])
    np.testing.assert_allclose(streamed, delayed_pose(times, q, times, delay_s), atol=1e-14)


def test_the_hips_are_never_delayed(rng: np.random.Generator) -> None:
    """The hips pass through the delay buffer unchanged at any delay."""
    times, q = _movement(rng)
    np.testing.assert_array_equal(delayed_pose(times, q, times, 0.35)[:, 0], q[:, 0])


def test_the_avatar_is_where_the_participant_was() -> None:
    """A delayed joint that turns at constant speed lags by speed times delay."""
    times = np.arange(0, 200) / 90.0
    vector = np.zeros((200, 22, 3))
    vector[:, :, 1] = times[:, np.newaxis] * 0.5
    delayed = delayed_pose(times, rot.from_rotation_vector(vector), times, 0.125)
    lag = rot.geodesic_angle(delayed, rot.from_rotation_vector(vector))
    np.testing.assert_allclose(lag[20:, 1:], 0.5 * 0.125, atol=1e-9)
    # Until a sample of that age exists, the first one is used.
    np.testing.assert_array_equal(delayed[5, 1:], rot.identity(21))


def test_a_delay_of_whole_frames_copies_samples_exactly(rng: np.random.Generator) -> None:
    """A sample at exactly the delayed time is copied without interpolation."""
    times = np.arange(50) / 64.0
    q = rot.normalise(rng.normal(size=(50, 22, 4)))
    np.testing.assert_array_equal(delayed_pose(times, q, times, 4 / 64.0)[10:, 1:], q[6:-4, 1:])


def test_a_changed_delay_applies_from_the_next_frame(rng: np.random.Generator) -> None:
    """After a change the delay buffer responds as if the new delay had always been set."""
    times, q = _movement(rng)
    buffer = DelayBuffer(0.125)
    for t, row in zip(times[:100], q[:100], strict=True):
        buffer.push(t, row)
    buffer.set_delay(0.35)
    assert buffer.delay_s == 0.35
    after = buffer.push(times[100], q[100])
    np.testing.assert_allclose(after, delayed_pose(times, q, times[100:101], 0.35)[0], atol=1e-14)


@pytest.mark.parametrize("delay_s", [-0.1, float("nan"), float("inf"), 2.1])
def test_an_impossible_delay_is_rejected(delay_s: float) -> None:
    """Negative, non-finite and too long delays are rejected."""
    with pytest.raises(DelayError, match="delay"):
        DelayBuffer(delay_s)


def test_times_must_rise(rng: np.random.Generator) -> None:
    """A sample whose time does not increase is rejected, in a stream and in a batch."""
    _, q = _movement(rng, 2)
    with pytest.raises(DelayError, match="rise"):
        delayed_pose(np.array((1.0, 1.0)), q, np.array((1.0,)), 0.1)
    buffer = DelayBuffer(0.1)
    buffer.push(1.0, q[0])
    with pytest.raises(DelayError, match="push in order"):
        buffer.push(1.0, q[1])
    with pytest.raises(DelayError, match="one time per sample"):
        delayed_pose(np.array((1.0,)), q, np.array((1.0,)), 0.1)
