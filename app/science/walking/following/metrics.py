"""How far an agent's walk is from a person's.

`EuclideanMetric` is the paper's equation 5. `PaceMetric` looks at progress only, whatever the shape
of the path: it serves where only distance over time was recorded, and proves that metrics can be
exchanged.
"""

from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records import Reference, Trajectories, WalkingError


@dataclass(frozen=True)
class EuclideanMetric:
    """Sum over the reference's samples of the distance between both, over the reference's length.

    An agent that has arrived earlier waits at its last place. The sum grows with the rate of
    samples, which cancels in every reading as suitability.
    """

    name: str = "euclidean"

    def deviations(self, reference: Reference, trajectories: Trajectories) -> FloatArray:
        """Return (K,) deviations; raises WalkingError for a reference of no length."""
        from app.science.walking.following.following_kernels import distance_sums

        _check(reference, trajectories)
        sums = distance_sums(reference.xy_m, trajectories.xy_m)
        deviations: FloatArray = sums / reference.length_m
        return deviations


@dataclass(frozen=True)
class PaceMetric:
    """Mean difference of the distances covered by each time, over the reference's length."""

    name: str = "pace"

    def deviations(self, reference: Reference, trajectories: Trajectories) -> FloatArray:
        """Return (K,) deviations; raises WalkingError for a reference of no length."""
        _check(reference, trajectories)
        apart = np.abs(_covered(trajectories.xy_m) - _covered(reference.xy_m))
        deviations: FloatArray = apart.mean(axis=-1) / reference.length_m
        return deviations


def _covered(xy_m: FloatArray) -> FloatArray:
    """Distance walked (..., N) up to each sample of (..., N, 2)."""
    steps = np.linalg.norm(np.diff(xy_m, axis=-2), axis=-1)
    covered = np.zeros(xy_m.shape[:-1])
    np.cumsum(steps, axis=-1, out=covered[..., 1:])
    return covered


def _check(reference: Reference, trajectories: Trajectories) -> None:
    if not reference.length_m > 0.0:
        raise WalkingError("A reference that does not move has no length to compare with.")
    if trajectories.xy_m.shape[1:] != reference.xy_m.shape:
        raise WalkingError(
            f"Trajectories {trajectories.xy_m.shape} do not have the {len(reference.xy_m)} samples"
            " of their reference."
        )
