"""Interpolate a map between its nodes: multilinearly, or by radial basis functions.

Multilinear: each node has a tent function, 1 at the node and falling linearly to 0 at the next
nodes along each axis; the map is the sum of tents times node values. It is never higher than the
highest node, never negative, and blending commutes with it.

Radial basis functions, as in the paper: a sum of multiquadrics sqrt((r / eps)^2 + 1) around all
nodes, with coefficients such that it interpolates all of them, and with eps = (product of ranges /
K)^(1/n), which is .19 on the paper's grid. It can fall below zero between nodes; as a density it
counts as 0 there. All maps over a grid share one matrix, so coefficients are one product, and are
linear in the map: blending commutes with it too.
"""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.maps.densifying import MAP_FLOATS, IntArray, MapArray
from app.science.walking.records import ParameterGrid, WalkingError

MOST_NODES = 4096
"""Limit on a grid's nodes: more would need a matrix of more than 130 MB."""


@dataclass(frozen=True, eq=False)
class Axes:
    """A grid in the form that compiled code uses.

    Attributes:
        values: the axes' values, one axis after the other.
        shape: (n,) number of values of each axis.
        node_weights: (K,) integral of each node's tent function.
    """

    values: FloatArray
    shape: IntArray
    node_weights: FloatArray


@lru_cache(maxsize=32)
def axes_of(grid: ParameterGrid) -> Axes:
    """Return the grid's axes; for an axis of one value, tents have width and weight 1."""
    weights = np.ones(1)
    for values in grid.values:
        weights = np.outer(weights, _tents(np.array(values))).ravel()
    joined = np.concatenate([np.array(values) for values in grid.values])
    return Axes(joined, np.array(grid.shape, dtype=np.int64), weights)


def _tents(values: FloatArray) -> FloatArray:
    if len(values) == 1:
        return np.ones(1)
    halves = np.diff(values) / 2.0
    tents: FloatArray = np.concatenate([halves, [0.0]]) + np.concatenate([[0.0], halves])
    return tents


def multilinear(grid: ParameterGrid, values: FloatArray, points: FloatArray) -> FloatArray:
    """Interpolate a map of node values (K,) multilinearly at points (P, n) within the grid."""
    from app.science.walking.maps.interpolation_kernels import multilinear_at

    axes = axes_of(grid)
    return multilinear_at(
        np.ascontiguousarray(values, dtype=np.float64).ravel(),
        axes.values,
        axes.shape,
        np.ascontiguousarray(points, dtype=np.float64),
    )


@dataclass(frozen=True, eq=False)
class RadialBasis:
    """Multiquadrics around the nodes of a grid.

    Attributes:
        grid: the grid of the nodes.
        epsilon: the width of the multiquadrics.
    """

    grid: ParameterGrid
    epsilon: float

    @cached_property
    def inverse(self) -> FloatArray:
        """The inverse (K, K) of the matrix of basis functions at the nodes."""
        matrix = basis_matrix(self.grid.nodes, self.epsilon)
        return np.asarray(np.linalg.inv(matrix), dtype=np.float64)

    def coefficients(self, values: FloatArray) -> FloatArray:
        """Return the coefficients (..., K) of maps of node values (..., K)."""
        found: FloatArray = values @ self.inverse.T
        return found

    def coefficients_of_many(self, maps: MapArray) -> MapArray:
        """Return the coefficients (N, K) of many maps, in the maps' own precision.

        They are computed in batches to limit the memory.
        """
        found = np.empty(maps.shape, dtype=MAP_FLOATS)
        for first in range(0, len(maps), 1024):
            part = slice(first, first + 1024)
            found[part] = maps[part].astype(np.float64) @ self.inverse.T
        return found

    def at(self, coefficients: FloatArray, points: FloatArray) -> FloatArray:
        """Evaluate the interpolation at points (P, n)."""
        from app.science.walking.maps.interpolation_kernels import radial_at

        axes = axes_of(self.grid)
        return radial_at(
            np.ascontiguousarray(coefficients, dtype=np.float64),
            axes.values,
            axes.shape,
            1.0 / self.epsilon,
            np.ascontiguousarray(points, dtype=np.float64),
        )

    def leave_one_out(self, values: FloatArray) -> FloatArray:
        """Return the error of each node's value (..., K) if it were left out: truth minus estimate.

        Rippa (1999), "An algorithm for selecting a good value for the parameter c in radial basis
        function interpolation": the i-th error is c_i / (A^-1)_ii, without solving K times.
        """
        errors: FloatArray = self.coefficients(values) / np.diag(self.inverse)
        return errors


@lru_cache(maxsize=4)
def radial_basis(grid: ParameterGrid) -> RadialBasis:
    """Return the paper's basis on a grid; raise WalkingError if the grid has too many nodes."""
    if grid.size > MOST_NODES:
        raise WalkingError(
            f"Radial basis functions over {grid.size} nodes need too much memory, {MOST_NODES} are"
            " possible: use the multilinear interpolation, or a coarser grid."
        )
    return RadialBasis(grid, width_of(grid))


def width_of(grid: ParameterGrid) -> float:
    """Return (product of ranges / K)^(1/n), over the axes that have more than one value."""
    ranges = [values[-1] - values[0] for values in grid.values if len(values) > 1]
    return float((math.prod(ranges) / grid.size) ** (1.0 / len(ranges))) if ranges else 1.0


def basis_matrix(nodes: FloatArray, epsilon: float) -> FloatArray:
    """Return the multiquadrics between all nodes (K, n), as a matrix (K, K)."""
    squares = ((nodes[:, None, :] - nodes[None, :, :]) ** 2).sum(axis=-1)
    matrix: FloatArray = np.sqrt(squares / epsilon**2 + 1.0)
    return matrix
