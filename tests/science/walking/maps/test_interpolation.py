"""Tests of interpolation of maps between their nodes."""

import numpy as np
import pytest
from scipy.interpolate import Rbf, RegularGridInterpolator

from app.science.walking.maps.interpolation import (
    axes_of,
    basis_matrix,
    multilinear,
    radial_basis,
    width_of,
)
from app.science.walking.records.model import WalkingError
from app.science.walking.records.parameters import (
    PAPER_GRID,
    PAPER_PARAMETERS,
    ParameterGrid,
    SteeringParameter,
    regular_grid,
)

UNEVEN = ParameterGrid(PAPER_PARAMETERS, ((0.1, 0.3, 1.0, 1.9), (0.5,), (0.2, 0.9, 2.0)))


def test_the_papers_width_is_19_hundredths() -> None:
    """The default width on the paper's grid is (1.9^3 / 1000)^(1/3) = .19."""
    assert width_of(PAPER_GRID) == pytest.approx(0.19)


def test_multilinear_is_scipys() -> None:
    """Multilinear interpolation equals scipy's on an uneven grid with one axis fixed."""
    rng = np.random.default_rng(1)
    values = rng.random(UNEVEN.size)
    points = np.column_stack([rng.uniform(0.1, 1.9, 200), np.full(200, 0.5),
                              rng.uniform(0.2, 2.0, 200)])  # fmt: skip
    theirs = RegularGridInterpolator((UNEVEN.values[0], UNEVEN.values[2]), values.reshape(4, 3))
    assert multilinear(UNEVEN, values, points) == pytest.approx(theirs(points[:, [0, 2]]))
    assert multilinear(UNEVEN, values, UNEVEN.nodes) == pytest.approx(values)


def test_tents_integrate_the_map() -> None:
    """Node weights integrate exactly what is linear along each axis, here v times omega."""
    exact = (1.9**2 - 0.1**2) / 2.0 * (2.0**2 - 0.2**2) / 2.0
    function = UNEVEN.nodes[:, 0] * UNEVEN.nodes[:, 2]
    assert float(axes_of(UNEVEN).node_weights @ function) == pytest.approx(exact)


def test_radial_bases_are_scipys() -> None:
    """Radial bases equal scipy's `Rbf` with the paper's defaults at random points."""
    grid = regular_grid(PAPER_PARAMETERS, 6)
    rng = np.random.default_rng(2)
    values, points = rng.random(grid.size), rng.uniform(0.1, 2.0, (100, 3))
    theirs = Rbf(*grid.nodes.T, values)
    basis = radial_basis(grid)
    assert basis.epsilon == pytest.approx(float(theirs.epsilon))
    ours = basis.at(basis.coefficients(values), points)
    assert ours == pytest.approx(theirs(*points.T), abs=1e-9)


def test_leaving_out_by_rippa_is_leaving_out() -> None:
    """Rippa's leave-one-out errors equal those of solving without each node, to 1e-9."""
    grid = regular_grid(PAPER_PARAMETERS, 5)
    values = np.random.default_rng(3).random(grid.size)
    basis = radial_basis(grid)
    matrix = basis_matrix(grid.nodes, basis.epsilon)
    brute = np.empty(grid.size)
    for at in range(grid.size):
        others = np.arange(grid.size) != at
        found = np.linalg.solve(matrix[np.ix_(others, others)], values[others])
        brute[at] = values[at] - matrix[at, others] @ found
    assert np.abs(basis.leave_one_out(values) - brute).max() < 1e-9


def test_a_grid_too_fine_for_one_matrix_is_rejected() -> None:
    """A grid whose matrix would not fit into memory is rejected before it is allocated."""
    one = SteeringParameter("gain", "", 0.0, 1.0)
    with pytest.raises(WalkingError, match="multilinear"):
        radial_basis(regular_grid((one,), 5000))
