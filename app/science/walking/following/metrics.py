"""Metrics of the deviation of an agent's walk from a person's.

`EuclideanMetric` is the paper's equation 5. `PaceMetric` compares progress only, whatever the shape
of the path: it is for recordings of distance over time only, and shows that metrics can be
exchanged.
"""

from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records import Reference, Trajectories, WalkingError


@dataclass(frozen=True)
class EuclideanMetric:
    """Sum of the distances between agent and reference at its samples, over the reference's length.

    An agent that has arrived earlier stays at its last position. The sum grows with the sampling
    rate, which cancels out when deviations are converted to suitability.
    """

    name: str = "euclidean"

    def deviations(self, reference: Reference, trajectories: Trajectories) -> FloatArray:
        """Return the deviations, (K,); raise WalkingError for a reference without length."""
        from app.science.walking.following.following_kernels import distance_sums

        _check(reference, trajectories)
        sums = distance_sums(reference.xy_m, trajectories.xy_m)
        deviations: FloatArray = sums / reference.length_m
        return deviations


@dataclass(frozen=True)
class PaceMetric:
    """Mean difference of the distances covered at each time, over the reference's length."""

    name: str = "pace"

    def deviations(self, reference: Reference, trajectories: Trajectories) -> FloatArray:
        """Return the deviations, (K,); raise WalkingError for a reference without length."""
        _check(reference, trajectories)
        apart = np.abs(_covered(trajectories.xy_m) - _covered(reference.xy_m))
        deviations: FloatArray = apart.mean(axis=-1) / reference.length_m
        return deviations


def _covered(xy_m: FloatArray) -> FloatArray:
    """Return the distance walked (..., N) up to each sample of (..., N, 2)."""
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
