"""Draw steering parameters for a query to the database.

The blended map of a query is f = sum over neighbours of w_i S_i. Interpreted as a density, it is
drawn from in two ways.

`mixture`, the default: S_i is a sum of tents around its nodes, so f is a mixture over neighbours,
nodes and tents. A neighbour is chosen by w_i times its map's mass, a node by its value times its
tent's mass, and a position in the tent directly. Nothing is blended or rejected, and the result has
exactly the density of the blended multilinear map.

`rejection`, as in the paper: blend the maps, interpolate by radial basis functions (or
multilinearly), propose uniformly, accept below f. The largest value of f between nodes is assumed
to be 1.02 times the largest at a node, which is valid for the multilinear map and, apart from
overshoots, for the radial one.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.maps import BlendingSpace, axes_of, radial_basis
from app.science.walking.records import WalkingError

HEADROOM = 1.02
PROPOSALS = 64
MOST_PROPOSALS = 50_000_000
Interpolation = Literal["multilinear", "radial"]


@dataclass(frozen=True, eq=False)
class Density:
    """The blended map of one query, prepared for many draws.

    Attributes:
        space: the space from which it was blended.
        grid_values: (K,) the blended map at nodes.
        coefficients: (K,) coefficients of radial basis functions; empty if these are not used.
    """

    space: BlendingSpace
    grid_values: FloatArray
    coefficients: FloatArray

    @cached_property
    def cumulative(self) -> FloatArray:
        """The cumulative masses of the nodes' tents, (K,)."""
        return np.cumsum(self.grid_values * axes_of(self.space.grid).node_weights)

    def draw(self, count: int, rng: np.random.Generator) -> FloatArray:
        """Draw vectors (count, n) from the blended multilinear map, without rejection."""
        from app.science.walking.models.sampling_kernels import tent_draws

        axes = axes_of(self.space.grid)
        vectors = np.empty((count, len(axes.shape)))
        uniforms = rng.random((count, 1 + 2 * len(axes.shape)))
        tent_draws(self.cumulative, axes.values, axes.shape, uniforms, vectors)
        return vectors

    def draw_by_rejection(self, count: int, rng: np.random.Generator) -> FloatArray:
        """Draw vectors (count, n) by rejection, as in the paper; radial if there are coefficients.

        Raises:
            WalkingError: too few proposals were accepted out of `MOST_PROPOSALS`.
        """
        from app.science.walking.models.sampling_kernels import reject

        axes, radial = axes_of(self.space.grid), len(self.coefficients) > 0
        width = 1.0 / radial_basis(self.space.grid).epsilon if radial else 0.0
        used = self.coefficients if radial else self.grid_values
        bound = HEADROOM * float(self.grid_values.max())
        vectors, filled, proposed = np.empty((count, len(axes.shape))), 0, 0
        rows = max(PROPOSALS, min(4 * count, 100_000))
        while filled < count:
            if proposed >= MOST_PROPOSALS:
                raise WalkingError(f"{proposed} proposals were not enough: the map is too narrow.")
            uniforms = rng.random((rows, len(axes.shape) + 1))
            filled = reject(used, axes.values, axes.shape, width, bound, uniforms, vectors, filled)
            proposed += rows
        return vectors


def density_of(
    space: BlendingSpace, z: FloatArray, interpolation: Interpolation = "multilinear"
) -> Density:
    """Return the density for a query, given as z-scores (m,).

    Raises:
        WalkingError: all neighbours' maps are zero.
    """
    from app.science.walking.models.sampling_kernels import blend_rows

    indices, weights = space.neighbours(z)
    grid_values = blend_rows(indices, weights, space.values)
    if not grid_values.max() > 0.0:
        raise no_suitable_error()
    coefficients = np.empty(0)
    if interpolation == "radial":
        coefficients = blend_rows(indices, weights, space.radial_coefficients)
    return Density(space, grid_values, coefficients)


@dataclass(frozen=True, eq=False)
class MixtureSampler:
    """Draws single vectors, each for a different query."""

    space: BlendingSpace

    def draw_one(self, z: FloatArray, rng: np.random.Generator) -> FloatArray:
        """Draw one vector (n,) for z-scores (m,); raise WalkingError if nothing is suitable."""
        dimensions = len(self.space.grid.shape)
        vector = np.empty(dimensions)
        if not self._draw(z, rng.random(2 + 2 * dimensions), vector):
            raise no_suitable_error()
        return vector

    @cached_property
    def _draw(self) -> Callable[[FloatArray, FloatArray, FloatArray], bool]:
        """The compiled draw, with its constant arguments looked up once."""
        from app.science.walking.models.sampling_kernels import mixture_draw

        space, axes, tree = self.space, axes_of(self.space.grid), self.space.tree
        k, masses, values = space.k, space.masses, space.values
        points, order, split_axes, splits = tree.points, tree.order, tree.axes, tree.splits
        lows, firsts, lasts = tree.lows, tree.firsts, tree.lasts
        tents, axis_values, shape = axes.node_weights, axes.values, axes.shape

        def draw(z: FloatArray, uniforms: FloatArray, vector: FloatArray) -> bool:
            return mixture_draw(
                points,
                order,
                split_axes,
                splits,
                lows,
                firsts,
                lasts,
                z,
                k,
                masses,
                values,
                tents,
                axis_values,
                shape,
                uniforms,
                vector,
            )

        return draw


def no_suitable_error() -> WalkingError:
    """Return the error for maps that are all zero."""
    return WalkingError(
        "No neighbour's map has a suitable combination: use a lower threshold or power, or widen"
        " the grid."
    )
