"""Densify a database: blends of neighbouring walks fill the space between them.

After Kovar and Gleicher (2004), "Automated extraction and parameterization of motions in large data
sets": a target is drawn uniformly from the space, its nearest walks are blended with random weights
that sum to 1, each from -.1 to 1.1, so that blends extend a little beyond the captured walks, and
the same weights give the blend's dependencies and its map.

Walks on the same course are equally near to every target. Which of them are blended is drawn, too:
in the order of a partial sort, the same few would be blended again and again, and which ones would
depend on the processor, for which NumPy chooses its way of sorting.

A blend stores its parents. Densify the training walks of a fold, never all walks before they are
split: blends of a held-out person would be in the training set.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray
from app.science.walking.records import WalkingError

LEAST_WEIGHT, MOST_WEIGHT = -0.1, 1.1
MAP_FLOATS = np.float32
"""Suitability, a number from 0 to 1, is stored with seven digits."""
IntArray = npt.NDArray[np.int64]
MapArray = npt.NDArray[np.float32]
_AT_ONCE = 512
"""Number of blends computed together, to limit the memory."""


@dataclass(frozen=True, eq=False)
class Blends:
    """B blends of N walks, each of p parents.

    Attributes:
        parents: (B, p) indices of the walks, nearest first.
        weights: (B, p) weights of the parents, each in [-.1, 1.1]; a row sums to 1.
    """

    parents: IntArray
    weights: FloatArray

    def of_vectors(self, vectors: FloatArray) -> FloatArray:
        """Return the blends' dependency vectors (B, m) from those of the walks (N, m).

        A dependency in which all parents of a blend are equal is exactly theirs: a rounded sum
        would put blends of one course beside it, and the processor would decide which are nearest.
        """
        own = vectors[self.parents]
        alike = (own == own[:, :1]).all(axis=1)
        return np.where(alike, own[:, 0], np.einsum("bp,bpm->bm", self.weights, own))

    def of_maps(self, values: MapArray) -> MapArray:
        """Return the blends' maps (B, K) from those of the walks (N, K), clipped to [0, 1]."""
        blended = np.empty((len(self.parents), values.shape[1]), dtype=MAP_FLOATS)
        for first in range(0, len(self.parents), _AT_ONCE):
            part = slice(first, first + _AT_ONCE)
            weights = self.weights[part].astype(MAP_FLOATS)
            sums = np.zeros((len(weights), values.shape[1]), dtype=MAP_FLOATS)
            for parent in range(weights.shape[1]):
                sums += weights[:, parent, None] * values[self.parents[part, parent]]
            blended[part] = np.clip(sums, 0.0, 1.0)
        return blended

    def as_matrix(self, walks: int) -> FloatArray:
        """Return the weight of each walk in each blend, (B, N)."""
        matrix = np.zeros((len(self.parents), walks))
        np.add.at(matrix, (np.arange(len(self.parents))[:, None], self.parents), self.weights)
        return matrix


def drawn_blends(z: FloatArray, count: int, rng: np.random.Generator) -> Blends:
    """Draw random blends of neighbouring walks.

    Args:
        z: (N, m) positions of the walks in the space.
        count: number of blends.
        rng: random generator for the targets and the weights; ties are drawn by a child of it.

    Raises:
        WalkingError: there are fewer than two walks, or the count is negative.
    """
    walks, dimensions = z.shape
    if walks < 2 or count < 0:
        raise WalkingError(f"{count} blends of {walks} walks are not possible: give two or more.")
    parents = min(dimensions + 1, walks)
    targets = rng.uniform(z.min(axis=0), z.max(axis=0), size=(count, dimensions))
    nearest = np.empty((count, parents), dtype=np.int64)
    (lots,) = rng.spawn(1)
    for first in range(0, count, _AT_ONCE):
        part = slice(first, first + _AT_ONCE)
        apart = ((targets[part, None, :] - z[None, :, :]) ** 2).sum(axis=-1)
        nearest[part] = _nearest(apart, parents, lots)
    return Blends(nearest, drawn_weights(count, parents, rng))


def _nearest(apart: FloatArray, count: int, rng: np.random.Generator) -> IntArray:
    """Return the smallest of each row's distances (B, N) as indices (B, count), smallest first.

    Of equal distances one is drawn. The distances are overwritten.
    """
    rows = np.arange(len(apart))
    lots = rng.random(apart.shape)
    chosen = np.empty((len(apart), count), dtype=np.int64)
    for place in range(count):
        tied = apart == apart.min(axis=1, keepdims=True)
        chosen[:, place] = at = np.where(tied, lots, -1.0).argmax(axis=1)
        apart[rows, at] = np.inf
    return chosen


def drawn_weights(count: int, parents: int, rng: np.random.Generator) -> FloatArray:
    """Draw weights (count, parents) uniformly from those in [-.1, 1.1] that sum to 1."""
    weights = np.empty((0, parents))
    while len(weights) < count:
        free = rng.uniform(LEAST_WEIGHT, MOST_WEIGHT, size=(4 * count + 16, parents - 1))
        last = 1.0 - free.sum(axis=1, keepdims=True)
        fits = ((last >= LEAST_WEIGHT) & (last <= MOST_WEIGHT))[:, 0]
        weights = np.concatenate([weights, np.hstack([free, last])[fits]])
    chosen: FloatArray = weights[:count]
    return chosen
