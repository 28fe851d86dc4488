"""Tests of the bounded least-squares step against its defining conditions and SciPy."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from app.science.avatar.ik.bounded_step import bounded_step
from app.science.rotations import FloatArray


def _problem(seed: int, size: int = 41) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return the terms of a step towards five distant goals, where many bounds are active."""
    rng = np.random.default_rng(seed)
    matrix = rng.normal(size=(30, size)) * np.tile((3.0, 3.0, 3.0, 1.0, 1.0, 1.0), 5)[:, None]
    pull = matrix.T @ rng.normal(size=30)
    hessian = matrix.T @ matrix + np.eye(size)
    return hessian, pull, -rng.uniform(0, 0.3, size), rng.uniform(0, 0.3, size)


@pytest.mark.parametrize("seed", range(40))
def test_the_step_is_optimal_within_the_bounds(seed: int) -> None:
    """The step meets the Karush-Kuhn-Tucker conditions.

    The gradient of free unknowns is zero; that of unknowns at a bound points outwards.
    """
    hessian, pull, low, high = _problem(seed)
    step = bounded_step(hessian, pull, low, high)
    left = pull - hessian @ step
    at_low, at_high = step == low, step == high
    assert (step >= low).all()
    assert (step <= high).all()
    assert float(np.max(np.abs(left[~(at_low | at_high)]), initial=0.0)) < 1e-9
    assert (left[at_low] <= 1e-9).all()
    assert (left[at_high] >= -1e-9).all()
    assert (at_low | at_high).any()


@pytest.mark.parametrize("seed", range(10))
def test_scipy_finds_the_same_step(seed: int) -> None:
    """SciPy's bounded-variable least squares, an independent algorithm, finds the same step."""
    hessian, pull, low, high = _problem(seed)
    root = np.linalg.cholesky(hessian)
    found = lsq_linear(root.T, np.linalg.solve(root, pull), (low, high), method="bvls", tol=1e-14)
    np.testing.assert_allclose(bounded_step(hessian, pull, low, high), found.x, atol=1e-7)


def test_without_bounds_it_is_the_solution_of_the_equations() -> None:
    """With infinite bounds the step solves the unbounded normal equations."""
    hessian, pull, low, _ = _problem(1)
    far = np.full(len(low), np.inf)
    step = bounded_step(hessian, pull, -far, far)
    np.testing.assert_allclose(hessian @ step, pull, atol=1e-9)
