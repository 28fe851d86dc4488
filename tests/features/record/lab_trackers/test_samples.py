"""Tests of the columns in which what trackers sent is stored."""

import math

import numpy as np
import pytest

from app.adapters.live import Pose
from app.features.movement.live import Sample
from app.features.record.lab_trackers.samples import decode_samples, encode_samples

IDENTITY = (1.0, 0.0, 0.0, 0.0)


def test_every_bit_comes_back() -> None:
    """Poses with and without halves, clocks and tracking are decoded as they were encoded."""
    rng = np.random.default_rng(1)
    samples = [
        Sample(
            "osc",
            "lab",
            "127.0.0.1:5000",
            (
                Pose("a", "tracker", tuple(rng.normal(size=3)), tuple(rng.normal(size=4))),
                Pose("b", "tracker", (0.1, 0.2, 0.3), None, tracked=False),
                Pose("c", "bone", None, IDENTITY),
            ),
            None if n % 2 else 3.0 + n / 90,
            100.0 + n / 90,
            100.0 + n / 90 - 1e-9,
            None if n % 3 else 2e-4,
        )
        for n in range(50)
    ]
    trackers, count, data = encode_samples(samples)
    found = decode_samples(trackers, count, data)
    assert (found.trackers, count) == (("a", "b", "c"), 150)
    poses = [(one, pose) for one in samples for pose in one.poses]
    for n, (one, pose) in enumerate(poses):
        assert found.trackers[found.tracker[n]] == pose.tracker
        assert bool(found.tracked[n]) == pose.tracked
        assert found.arrival_s[n] == one.arrival_s
        assert found.mapped_s[n] == one.mapped_s
        assert _same(found.source_s[n], one.source_s)
        assert _same(found.uncertainty_s[n], one.uncertainty_s)
        assert pose.position_m is None or tuple(found.positions_m[n]) == pose.position_m
        assert pose.rotation is None or tuple(found.rotations[n]) == pose.rotation
        assert np.isnan(found.positions_m[n]).all() == (pose.position_m is None)
        assert np.isnan(found.rotations[n]).all() == (pose.rotation is None)


def _same(found: float, given: float | None) -> bool:
    return math.isnan(found) if given is None else found == given


def test_damaged_columns_are_refused() -> None:
    """Bytes that are not compressed columns, of another length, or about unknown trackers."""
    pose = Pose("a", "tracker", (0.0, 0.0, 0.0), IDENTITY)
    trackers, count, data = encode_samples([Sample("osc", "lab", "x:1", (pose,), None, 1, 1, None)])
    for wrong in ((trackers, count, data[:-3]), (trackers, 2, data), ([], count, data)):
        with pytest.raises(ValueError, match="tracker samples"):
            decode_samples(*wrong)
