"""Tests of grounds: their heights at given places, and invalid grounds."""

import numpy as np
import pytest

from app.science.retargeting.ground import Flat, Grid, GroundError, Ramp, Steps


def test_flat_ground_has_one_height_in_the_shape_of_its_places() -> None:
    """Heights of flat ground have the shape of the places, which are broadcast."""
    heights = Flat(0.3).height_m(np.zeros((4, 1)), np.zeros(3))
    assert heights.shape == (4, 3)
    assert np.all(heights == 0.3)
    assert float(Flat().height_m(1.0, 2.0)) == 0.0


def test_a_ramp_rises_evenly_between_its_ends() -> None:
    """A ramp is level before and after its ends, linear between, and constant across."""
    ramp = Ramp(start_m=(0.0, -1.0), uphill=(0.0, -3.0), run_m=2.0, rise_m=0.5)
    z = np.array((1.0, -1.0, -2.0, -3.0, -9.0))
    assert ramp.height_m(7.0, z).tolist() == [0.0, 0.0, 0.25, 0.5, 0.5]


def test_steps_add_up_at_their_edges() -> None:
    """Steps up and down add up, and an edge belongs to its upper side."""
    kerbs = Steps((0.0, 0.0), (1.0, 0.0), edges_m=(1.0, 3.0), rises_m=(0.12, -0.10))
    heights = kerbs.height_m(np.array((0.99, 1.0, 2.0, 3.0)), 0.0)
    assert heights == pytest.approx((0.0, 0.12, 0.12, 0.02), abs=1e-15)


def test_a_grid_is_bilinear_and_goes_on_beyond_its_edge() -> None:
    """A grid is interpolated bilinearly and keeps its edge's height outside."""
    x, z = np.meshgrid(np.arange(4), np.arange(3), indexing="ij")
    grid = Grid(corner_m=(-1.0, 2.0), cell_m=0.5, heights_m=0.1 * x - 0.2 * z)
    rng = np.random.default_rng(5)
    u, v = rng.uniform(0, 1.5, 200), rng.uniform(0, 1.0, 200)
    expected = 0.2 * u - 0.4 * v
    assert grid.height_m(-1.0 + u, 2.0 + v) == pytest.approx(expected, abs=1e-12)
    assert float(grid.height_m(99.0, -99.0)) == pytest.approx(0.3)


@pytest.mark.parametrize(
    ("build", "reason"),
    [
        (lambda: Ramp((0, 0), (0, 0), 1.0, 1.0), "not a direction"),
        (lambda: Ramp((0, 0), (1, 0), 0.0, 1.0), "above zero"),
        (lambda: Steps((0, 0), (1, 0), (1.0,), ()), "1 edges and 0 rises"),
        (lambda: Steps((0, 0), (1, 0), (2.0, 1.0), (1.0, 1.0)), "out of order"),
        (lambda: Grid((0, 0), 1.0, np.zeros((1, 5))), "not a grid"),
        (lambda: Grid((0, 0), 1.0, np.full((2, 2), np.nan)), "finite"),
    ],
)
def test_impossible_grounds_are_rejected(build: object, reason: str) -> None:
    """An impossible ground raises an error that states the reason."""
    assert callable(build)
    with pytest.raises(GroundError, match=reason):
        build()
