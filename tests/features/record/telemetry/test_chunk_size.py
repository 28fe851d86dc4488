"""Tests that a minute of recorded movement stays within its size limit."""

from pathlib import Path

import numpy as np
import pytest

from app.features.record.telemetry.encoding import encode_frames
from tests.features.record.telemetry.followed_movement import (
    CHUNK_FRAMES,
    RATE_HZ,
    Streams,
    captured_movement,
    followed,
    made_movement,
)

LIMIT_MB = 3.0
CAPTURES = ("02_01", "05_06", "06_01", "12_02")


def session_minute_mb(streams: Streams) -> float:
    """Return the size of 60 s of both streams in one-second chunks, in 10^6 bytes."""
    sizes = [
        len(encode_frames(one.times_s, one.flags, one.values))
        for pair in streams.chunks()
        for one in pair
    ]
    seconds = len(sizes) / 2 * CHUNK_FRAMES / RATE_HZ
    return sum(sizes) * 60.0 / seconds / 1e6


@pytest.mark.parametrize("noise_deg", [0.0, 0.01, 0.1, 1.0])
def test_a_generated_session_minute_stays_within_the_limit(noise_deg: float) -> None:
    """A minute of generated movement of all joints with noise takes at most 3 MB."""
    rng = np.random.default_rng(1)
    movement = made_movement(10.0, rng, noise_deg=noise_deg)
    assert session_minute_mb(followed(movement, rng, noise_deg=noise_deg)) <= LIMIT_MB


@pytest.mark.parametrize("capture", CAPTURES)
def test_a_captured_session_minute_stays_within_the_limit(shared_data: Path, capture: str) -> None:
    """A minute of a captured movement and a body that follows it takes at most 3 MB."""
    movement = captured_movement(shared_data / "motion" / "cmu_bvh" / f"{capture}.bvh")
    assert session_minute_mb(followed(movement, np.random.default_rng(2))) <= LIMIT_MB


def test_the_followed_stream_is_not_a_copy() -> None:
    """No joint rotation of the generated actual stream equals one of the target."""
    rng = np.random.default_rng(3)
    streams = followed(made_movement(3.0, rng), rng)
    target = {row.tobytes() for row in streams.target[:, 3:].reshape(-1, 4)}
    actual = {row.tobytes() for row in streams.actual[:, 3:].reshape(-1, 4)}
    assert target & actual == set()
