"""Scale dependencies to a common space: each number by its own standard deviation.

A metre of path, a radian per metre and a metre of stature cannot be compared. Distances between
walks are therefore computed on z-scores, (d - mean) / sd over the walks of the database. A
dependency that is the same for all of them carries no information and has weight zero.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records.model import WalkingError

SAME_SD = 1e-9
"""Relative standard deviation below which a dependency counts as constant."""


@dataclass(frozen=True, eq=False)
class Scaling:
    """The means and scales of m dependencies.

    Attributes:
        names: the names of the dependencies, in the order of a vector's columns.
        means: (m,) means in the dependencies' own units.
        inverse_sds: (m,) one over the standard deviation; 0 if all walks have the same value.
    """

    names: tuple[str, ...]
    means: FloatArray
    inverse_sds: FloatArray

    def vector(self, dependencies: Mapping[str, float]) -> FloatArray:
        """Return the numbers (m,) in their own units; names other than `names` are ignored.

        Raises:
            WalkingError: a dependency is missing, or not finite.
        """
        missing = [name for name in self.names if name not in dependencies]
        if missing:
            raise WalkingError(
                f"The model depends on {', '.join(self.names)}; {', '.join(missing)} is missing."
            )
        values = np.array([dependencies[name] for name in self.names], dtype=np.float64)
        if not np.isfinite(values).all():
            raise WalkingError(f"Dependencies {dict(dependencies)} must be finite numbers.")
        return values

    def z(self, vectors: FloatArray) -> FloatArray:
        """Return the z-scores of vectors (..., m)."""
        scores: FloatArray = (vectors - self.means) * self.inverse_sds
        return scores


def scaling_of(names: Sequence[str], vectors: FloatArray) -> Scaling:
    """Compute the scaling from the database's own vectors (N, m).

    Raises:
        WalkingError: there is no walk, or the number of columns differs from that of names.
    """
    if vectors.ndim != 2 or vectors.shape[1] != len(names) or not len(vectors) or not names:
        raise WalkingError(f"{len(names)} dependencies need vectors (N, m), got {vectors.shape}.")
    sds = vectors.std(axis=0)
    varies = sds > SAME_SD * np.maximum(1.0, np.abs(vectors).max(axis=0))
    inverse = np.zeros(len(names))
    inverse[varies] = 1.0 / sds[varies]
    return Scaling(tuple(names), vectors.mean(axis=0), inverse)


def dependency_vectors(
    names: Sequence[str], walks: Sequence[Mapping[str, float]], sources: Sequence[str]
) -> FloatArray:
    """Return the dependencies of N walks as vectors (N, m).

    Raises:
        WalkingError: a walk lacks one; the message names its source.
    """
    for dependencies, source in zip(walks, sources, strict=True):
        missing = [name for name in names if name not in dependencies]
        if missing:
            raise WalkingError(
                f"The walk from {source} has no {', '.join(missing)}: give it to all walks, or"
                " leave it out of the model."
            )
    rows = [[dependencies[name] for name in names] for dependencies in walks]
    return np.array(rows, dtype=np.float64).reshape(len(rows), len(names))
