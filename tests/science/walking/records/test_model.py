"""Tests of tracks, walks and paths: validation and derived values."""

import numpy as np
import pytest

from app.science.walking.records.model import PlannedPath, PlannedWalk, Track, Walk, WalkingError
from app.science.walking.records.parameters import (
    PAPER_GRID,
    VELOCITY,
    ParameterGrid,
    SteeringParameter,
)

TIMES = np.arange(5) / 10.0
LINE = np.stack([np.zeros(5), np.arange(5) * 0.1], axis=-1)


def test_a_walk_of_one_point_is_rejected() -> None:
    """A walk of one sample raises an error that states the number of samples that it needs."""
    with pytest.raises(WalkingError, match=r"1 point.*at least two"):
        Track(TIMES[:1], LINE[:1], "7", "a.csv")


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_positions_that_are_not_finite_are_rejected(bad: float) -> None:
    """Non-finite positions raise an error that states their number and the first index."""
    places = LINE.copy()
    places[2, 1] = bad
    with pytest.raises(WalkingError, match=r"1 sample.*index 2"):
        Track(TIMES, places, "7", "a.csv")


def test_times_that_do_not_increase_are_rejected() -> None:
    """A repeated time raises an error that states its index."""
    times = TIMES.copy()
    times[3] = times[2]
    with pytest.raises(WalkingError, match="index 3"):
        Track(times, LINE, "7", "a.csv")


def test_a_stature_in_centimetres_is_rejected() -> None:
    """A stature of 178 is rejected, since statures are in metres."""
    with pytest.raises(WalkingError, match="give metres"):
        Track(TIMES, LINE, "7", "a.csv", stature_m=178.0)


def test_a_walk_derives_length_speed_and_positions() -> None:
    """A steady walk of .4 m in .4 s has a speed of 1 m/s and stays at its ends before and after."""
    walk = Walk(TIMES, LINE, "7", "a.csv")
    assert walk.length_m == pytest.approx(0.4)
    assert walk.duration_s == pytest.approx(0.4)
    assert walk.speeds_m_s == pytest.approx(np.ones(5))
    assert walk.at(np.array([-1.0, 0.25, 9.0]))[:, 1] == pytest.approx([0.0, 0.25, 0.4])


@pytest.mark.parametrize(
    "points", [[[0.0, 0.0]], [[0.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [np.nan, 1.0]]]
)
def test_an_invalid_path_is_rejected(points: list[list[float]]) -> None:
    """A path without two different finite points is rejected."""
    with pytest.raises(WalkingError):
        PlannedPath(np.array(points))


def test_a_dependency_that_is_not_a_number_is_rejected() -> None:
    """A dependency that is not a number is rejected by name."""
    walk = Walk(TIMES, LINE, "7", "a.csv")
    with pytest.raises(WalkingError, match="load_kg"):
        PlannedWalk(walk, PlannedPath(LINE[[0, -1]]), {"load_kg": np.nan})


def test_the_papers_grid_is_the_papers() -> None:
    """The paper's grid has ten values from .1 to 2, with its static optimum (.94, 1.58, 1.79)."""
    assert PAPER_GRID.shape == (10, 10, 10)
    assert PAPER_GRID.nodes[0] == pytest.approx([0.1, 0.1, 0.1])
    assert PAPER_GRID.nodes[-1] == pytest.approx([2.0, 2.0, 2.0])
    node = PAPER_GRID.nodes.reshape(10, 10, 10, 3)[4, 7, 8]
    assert np.round(node, 2) == pytest.approx([0.94, 1.58, 1.79])


def test_a_grid_rejects_values_out_of_bounds_or_order() -> None:
    """A grid fixes a parameter by one value, and rejects values out of bounds or of order."""
    sway = SteeringParameter("sway", "m", 0.0, 0.1)
    grid = ParameterGrid((VELOCITY, sway), ((0.5, 1.0), (0.02,)))
    assert grid.nodes.tolist() == [[0.5, 0.02], [1.0, 0.02]]
    for values in ((0.5, 3.0), (1.0, 0.5), ()):
        with pytest.raises(WalkingError, match="velocity"):
            ParameterGrid((VELOCITY, sway), (values, (0.02,)))
    with pytest.raises(WalkingError, match="low < high"):
        SteeringParameter("sway", "m", 0.1, 0.1)
