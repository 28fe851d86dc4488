"""The dependency blending space: maps where their walks' dependencies put them.

A space is made of the maps of N walks and B blends of them. A question is a vector of dependencies;
its answer is the weighted sum of the maps of the k nearest entries.
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
    """Maps over the dependencies.

    Attributes:
        grid: of the maps.
        scaling: of the dependencies.
        z: (M, m) where each entry is; walks first, blends after them.
        values: (M, K) its suitability map.
        blends: parents of the entries after the walks.
        k: how many neighbours answer.
    """

    grid: ParameterGrid
    scaling: Scaling
    z: FloatArray
    values: MapArray
    blends: Blends
    k: int

    def __post_init__(self) -> None:
        """Raises WalkingError where there are not as many maps as places, or k is too large."""
        if self.values.shape != (len(self.z), self.grid.size):
            raise WalkingError(
                f"{len(self.z)} entries over {self.grid.size} nodes need maps of that shape, got"
                f" {self.values.shape}."
            )
        check_k(self.k, len(self.z))

    @property
    def walks(self) -> int:
        """N, how many entries are walks themselves."""
        return len(self.z) - len(self.blends.parents)

    @cached_property
    def tree(self) -> Tree:
        """Finds neighbours."""
        return tree_of(self.z)

    @cached_property
    def masses(self) -> FloatArray:
        """(M,) integral of each map."""
        masses: FloatArray = self.values @ axes_of(self.grid).node_weights
        return masses

    @cached_property
    def radial_coefficients(self) -> MapArray:
        """(M, K) of each map's radial basis functions."""
        return radial_basis(self.grid).coefficients_of_many(self.values)

    def neighbours(self, z: FloatArray) -> tuple[IntArray, FloatArray]:
        """Entries (k,) nearest to z-scores (m,), and their weights (k,)."""
        return neighbours(self.tree, z, self.k)

    def origins(self, z: FloatArray) -> FloatArray:
        """(N,) how much of an answer comes from each walk, blends traced to their parents.

        Up to the clipping of blends, the answer is the walks' maps weighed by this.
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
    """Make a space from walks, densified.

    Args:
        grid: of the maps.
        scaling: of the dependencies.
        vectors: (N, m) dependencies of the walks.
        values: (N, K) their suitability maps.
        rng: of the blends.
        entries: how many there shall be, blends included; no blends where the walks are more.
        k: neighbours; all entries where there are fewer.

    Raises:
        WalkingError: fewer than two walks to blend.
    """
    z = scaling.z(vectors)
    blends = drawn_blends(z, max(0, entries - len(z)), rng)
    all_values = np.concatenate([values, blends.of_maps(values)])
    all_z = np.concatenate([z, scaling.z(blends.of_vectors(vectors))])
    return BlendingSpace(grid, scaling, all_z, all_values, blends, min(k, len(all_z)))
