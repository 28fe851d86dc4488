"""Find the static model's single combination: the smallest mean deviation over all walks.

By simulated annealing as in Wolinski et al. (2014), "Parameter estimation and comparative
evaluation of crowd simulations". The mean deviation is known at the grid's nodes; between them it
is interpolated by radial basis functions, so that one step takes microseconds. The result is never
worse, by that function, than the best node.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.maps import MOST_NODES, WalkDatabase, radial_basis
from app.science.walking.records import ParameterGrid

STEPS = 4000
HOT, COLD = 0.5, 1e-4
"""Temperatures at start and end, relative to the standard deviation of the first values."""
RETURN = 0.7
"""Share of the steps after which the search continues from the best vector found."""
WIDE, NARROW = 0.4, 0.01
"""Widths of a step at start and end, relative to each axis."""


@dataclass(frozen=True, eq=False)
class StaticFit:
    """The result of fitting the static model.

    Attributes:
        vector: (n,) the best parameters found, by annealing or on the grid.
        deviation: their mean deviation over all walks.
        node: (n,) the best node of the grid.
        node_deviation: its mean deviation over all walks.
    """

    vector: FloatArray
    deviation: float
    node: FloatArray
    node_deviation: float


def static_fit(database: WalkDatabase, rng: np.random.Generator, steps: int = STEPS) -> StaticFit:
    """Find the best single combination of parameters for all walks of a database."""
    grid = database.grid
    mean = database.deviations.astype(np.float64).mean(axis=0)
    best = grid.size - 1 - int(np.argmin(mean[::-1]))
    node, node_deviation = grid.node(best), float(mean[best])
    if grid.size > MOST_NODES:
        return StaticFit(node, node_deviation, node, node_deviation)
    basis = radial_basis(grid)
    coefficients = basis.coefficients(mean)

    def deviation(vector: FloatArray) -> float:
        return float(basis.at(coefficients, vector[None])[0])

    vector, value = anneal(deviation, grid, rng, steps)
    if value > node_deviation:
        vector, value = node, node_deviation
    return StaticFit(vector, value, node, node_deviation)


def anneal(
    objective: Callable[[FloatArray], float],
    grid: ParameterGrid,
    rng: np.random.Generator,
    steps: int = STEPS,
) -> tuple[FloatArray, float]:
    """Minimise a function of a vector (n,) within a grid's bounds by simulated annealing.

    Returns:
        The best vector found, and its value.
    """
    low = np.array([values[0] for values in grid.values])
    range_ = np.array([values[-1] for values in grid.values]) - low
    trials = [low + rng.random(len(low)) * range_ for _ in range(20)]
    values = [objective(trial) for trial in trials]
    at = trials[int(np.argmin(values))]
    value = min(values)
    best, best_value = at, value
    spread = max(float(np.std(values)), 1e-300)
    for step in range(steps):
        done = step / max(1, steps - 1)
        if step == int(RETURN * steps):
            at, value = best, best_value  # it is cold by now and may be in a local minimum
        temperature = spread * HOT * (COLD / HOT) ** done
        width = WIDE * (NARROW / WIDE) ** done
        trial = low + _folded((at - low) / np.where(range_ > 0, range_, 1.0), width, rng) * range_
        trial_value = objective(trial)
        if trial_value <= value or rng.random() < math.exp((value - trial_value) / temperature):
            at, value = trial, trial_value
            if value < best_value:
                best, best_value = at, value
    return best, best_value


def _folded(share: FloatArray, width: float, rng: np.random.Generator) -> FloatArray:
    """Return a random step from a position in the unit cube, reflected at its faces."""
    moved = np.abs(share + width * rng.standard_normal(len(share))) % 2.0
    folded: FloatArray = np.where(moved > 1.0, 2.0 - moved, moved)
    return folded
