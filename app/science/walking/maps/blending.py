"""The dependency blending space: suitability maps at the positions of their walks' dependencies.

A space consists of the maps of N walks and B blends of them. A query is a vector of dependencies;
its result is the weighted sum of the maps of the k nearest entries.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.maps.densifying import Blends, IntArray, MapArray, drawn_blends
from app.science.walking.maps.interpolation import axes_of, radial_basis
from app.science.walking.maps.neighbours import Tree, check_k, neighbours, tree_of
from app.science.walking.records import ParameterGrid, Scaling, WalkingError

NEIGHBOURS = 100
ENTRIES = 5000


@dataclass(frozen=True, eq=False)
class BlendingSpace:
    """Suitability maps over the space of dependencies.

    Attributes:
        grid: the grid of the maps.
        scaling: the scaling of the dependencies.
        z: (M, m) position of each entry; walks first, then blends.
        values: (M, K) suitability map of each entry.
        blends: the blends, which are the entries after the walks.
        k: number of neighbours that contribute to a result.
    """

    grid: ParameterGrid
    scaling: Scaling
    z: FloatArray
    values: MapArray
    blends: Blends
    k: int

    def __post_init__(self) -> None:
        """Raise WalkingError if the maps do not match entries and grid, or k is out of range."""
        if self.values.shape != (len(self.z), self.grid.size):
            raise WalkingError(
                f"{len(self.z)} entries over {self.grid.size} nodes need maps of that shape, got"
                f" {self.values.shape}."
            )
        check_k(self.k, len(self.z))

    @property
    def walks(self) -> int:
        """N, the number of entries that are walks."""
        return len(self.z) - len(self.blends.parents)

    @cached_property
    def tree(self) -> Tree:
        """The k-d tree in which neighbours are searched."""
        return tree_of(self.z)

    @cached_property
    def masses(self) -> FloatArray:
        """The integral of each map, (M,)."""
        masses: FloatArray = self.values @ axes_of(self.grid).node_weights
        return masses

    @cached_property
    def radial_coefficients(self) -> MapArray:
        """The coefficients of each map's radial basis functions, (M, K)."""
        return radial_basis(self.grid).coefficients_of_many(self.values)

    def neighbours(self, z: FloatArray) -> tuple[IntArray, FloatArray]:
        """Return the entries (k,) nearest to z-scores (m,), and their weights (k,)."""
        return neighbours(self.tree, z, self.k)

    def origins(self, z: FloatArray) -> FloatArray:
        """Return each walk's share of the result at z-scores (m,), as (N,).

        Shares of blends are passed on to their parents. Apart from the clipping of blends, the
        result is the sum of the walks' maps weighted by these shares.
        """
        indices, weights = self.neighbours(z)
        own = np.zeros(self.walks)
        walks = indices < self.walks
        np.add.at(own, indices[walks], weights[walks])
        blends, share = indices[~walks] - self.walks, weights[~walks]
        np.add.at(own, self.blends.parents[blends], share[:, None] * self.blends.weights[blends])
        return own


def blending_space(
    grid: ParameterGrid,
    scaling: Scaling,
    vectors: FloatArray,
    values: MapArray,
    *,
    rng: np.random.Generator,
    entries: int = ENTRIES,
    k: int = NEIGHBOURS,
) -> BlendingSpace:
    """Make a blending space from walks, densified by blends.

    Args:
        grid: the grid of the maps.
        scaling: the scaling of the dependencies.
        vectors: (N, m) dependencies of the walks.
        values: (N, K) suitability maps of the walks.
        rng: random generator for the blends.
        entries: number of entries, blends included; there are no blends if there are more walks.
        k: number of neighbours; all entries if there are fewer.

    Raises:
        WalkingError: there are fewer than two walks to blend.
    """
    z = scaling.z(vectors)
    blends = drawn_blends(z, max(0, entries - len(z)), rng)
    all_values = np.concatenate([values, blends.of_maps(values)])
    all_z = np.concatenate([z, scaling.z(blends.of_vectors(vectors))])
    return BlendingSpace(grid, scaling, all_z, all_values, blends, min(k, len(all_z)))
