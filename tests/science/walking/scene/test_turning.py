"""Tests that turning per metre depends on a path's shape and not on its sampling."""

import numpy as np
import pytest

from app.science.rotations import FloatArray
from app.science.walking.records.model import WalkingError
from app.science.walking.scene.turning import by_length, total_turning, turning_per_m


def _arc(angle: float, radius_m: float, samples: int) -> FloatArray:
    angles = np.linspace(0.0, angle, samples)
    return radius_m * np.stack([np.cos(angles), np.sin(angles)], axis=-1)


def test_a_straight_path_does_not_turn() -> None:
    """A straight path has a turning of exactly zero."""
    assert turning_per_m(np.array([[0.0, 0.0], [1.3, 2.9]])) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("degrees", [45.0, 90.0, 135.0])
def test_a_bend_turns_by_its_angle(degrees: float) -> None:
    """A polyline with one bend turns by the bend's angle over its length, smoothed or not."""
    turn = np.radians(degrees)
    path = np.array([[0.0, 0.0], [0.0, 2.0], [2.0 * np.sin(turn), 2.0 + 2.0 * np.cos(turn)]])
    assert total_turning(path) == pytest.approx(turn, rel=1e-3)
    assert turning_per_m(path) == pytest.approx(turn / 4.0, rel=1e-3)


def test_a_circle_has_its_curvature() -> None:
    """A circle of radius 2 m turns by half a radian per metre, except at the excluded ends."""
    assert turning_per_m(_arc(np.pi, 2.0, 400)) == pytest.approx(0.5, rel=0.03)


def test_the_rate_of_sampling_does_not_matter() -> None:
    """60 and 6000 samples of a curve give the same turning, unlike the paper's sum."""
    few, many = (turning_per_m(_arc(2.0, 1.0, samples)) for samples in (60, 6000))
    assert few == pytest.approx(many, rel=2e-3)


def test_turns_to_both_sides_add_up() -> None:
    """Turns to the left and to the right add up."""
    path = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 2.0]])
    assert total_turning(path) == pytest.approx(np.pi, rel=1e-3)


def test_samples_are_equally_far_apart() -> None:
    """A path is sampled at equal distances along its length, with both ends kept."""
    line = by_length(np.array([[0.0, 0.0], [0.3, 0.4], [0.3, 1.0]]))
    assert len(line) == 111
    assert line[[0, -1]] == pytest.approx(np.array([[0.0, 0.0], [0.3, 1.0]]))
    with pytest.raises(WalkingError, match="no length"):
        by_length(np.zeros((3, 2)))
