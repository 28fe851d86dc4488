"""Tests that the mixture and rejection sampling draw from a blended map's density."""

import numpy as np
import pytest
from scipy import stats

from app.science.rotations import FloatArray
from app.science.walking.maps.interpolation import axes_of, multilinear
from app.science.walking.models.sampling import MixtureSampler, density_of
from app.science.walking.records.model import WalkingError
from app.science.walking.records.parameters import SteeringParameter, regular_grid
from tests.science.walking.spaces import made_up_space

DRAWS, ALPHA = 20_000, 0.001
DETECTABLE, POWER = 0.03, 0.95
"""A gap of .03 between distribution functions is detected with 20 000 draws at a power of .95."""
Z = np.array([0.3, -0.4])


def _largest_gap(first: FloatArray, second: FloatArray) -> float:
    return max(
        float(stats.ks_2samp(first[:, axis], second[:, axis]).statistic)
        for axis in range(first.shape[1])
    )


def test_the_stated_power_is_the_tests() -> None:
    """A gap of `DETECTABLE` exceeds the limit with probability `POWER`; chance does in .1 %.

    The deviation of a difference of two empirical functions at one point is at most sqrt(1 / 2n).
    """
    limit = _limit()
    deviation = np.sqrt(2 * 0.25 / DRAWS)
    assert 1.0 - stats.norm.cdf((limit - DETECTABLE) / deviation) > POWER


def _limit() -> float:
    """Return the critical KS distance of two samples at `ALPHA`, for each of three axes."""
    return float(np.sqrt(-np.log(ALPHA / 3 / 2) / DRAWS))


def test_mixture_prepared_and_rejection_agree() -> None:
    """Drawing by neighbour, from the blended map and by rejection gives the same density."""
    space, rng = made_up_space(), np.random.default_rng(1)
    mixture = MixtureSampler(space)
    drawn = np.stack([mixture.draw_one(Z, rng) for _ in range(DRAWS)])
    density = density_of(space, Z)
    prepared, rejected = density.draw(DRAWS, rng), density.draw_by_rejection(DRAWS, rng)
    assert _largest_gap(drawn, rejected) < _limit()
    assert _largest_gap(drawn, prepared) < _limit()
    apart = np.abs(np.corrcoef(drawn.T) - np.corrcoef(rejected.T)).max()
    assert apart < 5.0 / np.sqrt(DRAWS)


def test_another_query_has_a_detectably_different_density() -> None:
    """The same test distinguishes the densities of two queries at a small distance."""
    space, rng = made_up_space(), np.random.default_rng(2)
    here = density_of(space, Z).draw(DRAWS, rng)
    there = density_of(space, Z + np.array([0.2, 0.0])).draw(DRAWS, rng)
    assert _largest_gap(here, there) > _limit()


def test_draws_have_the_density_of_the_map() -> None:
    """The mean of a function over the draws equals its integral against the map."""
    space, rng = made_up_space(), np.random.default_rng(3)
    density = density_of(space, Z)
    fine = regular_grid(space.grid.parameters, 29)
    values = multilinear(space.grid, density.grid_values, fine.nodes) * axes_of(fine).node_weights
    drawn = density.draw(DRAWS, rng)
    for powers in ((1, 0, 0), (1, 1, 0), (0, 0, 2)):
        at_nodes, at_draws = (np.prod(points**powers, axis=1) for points in (fine.nodes, drawn))
        exact = float(values @ at_nodes / values.sum())
        error = float(at_draws.std()) / np.sqrt(DRAWS)
        assert float(at_draws.mean()) == pytest.approx(exact, abs=5.0 * error + 0.002)


def test_the_papers_radial_rejection_is_near_the_mixture() -> None:
    """Draws by the paper's radial rejection differ from the mixture by a few percent at most."""
    space, rng = made_up_space(), np.random.default_rng(4)
    radial = density_of(space, Z, "radial").draw_by_rejection(DRAWS, rng)
    assert _largest_gap(radial, density_of(space, Z).draw(DRAWS, rng)) < 0.1
    assert radial.min() >= 0.1
    assert radial.max() <= 2.0


def test_the_same_seed_draws_the_same() -> None:
    """Draws are determined by the random generator that is passed in."""
    space = made_up_space()
    one, two = (MixtureSampler(space).draw_one(Z, np.random.default_rng(5)) for _ in range(2))
    assert (one == two).all()


def test_maps_without_anything_suitable_are_rejected() -> None:
    """Drawing from a map that a high threshold leaves empty raises an error."""
    space = made_up_space()
    space.values[:] = 0.0
    for draw in (lambda: MixtureSampler(space).draw_one(Z, np.random.default_rng(1)),
                 lambda: density_of(space, Z)):  # fmt: skip
        with pytest.raises(WalkingError, match="suitable"):
            draw()


def test_any_bounded_parameter_can_be_drawn() -> None:
    """Any bounded parameters can be drawn, here two, one of them fixed."""
    parameters = (SteeringParameter("a", "", -5.0, 5.0), SteeringParameter("b", "", 0.0, 1.0))
    space = made_up_space()
    grid = regular_grid((*parameters, SteeringParameter("c", "", 3.0, 4.0)), 5)
    other = type(space)(grid, space.scaling, space.z, space.values, space.blends, space.k)
    drawn = MixtureSampler(other).draw_one(Z, np.random.default_rng(1))
    assert (drawn >= [-5.0, 0.0, 3.0]).all()
    assert (drawn <= [5.0, 1.0, 4.0]).all()
