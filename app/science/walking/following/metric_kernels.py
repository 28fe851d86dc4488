"""Sums of distances, compiled."""

import math

import numpy as np

from app.science.compiled import compiled
from app.science.rotations import FloatArray


@compiled
def distance_sums(reference: FloatArray, places: FloatArray) -> FloatArray:
    """(K,) sums over N samples of the distance between (N, 2) and each of (K, N, 2)."""
    sums = np.zeros(len(places))
    for agent in range(len(places)):
        for sample in range(len(reference)):
            dx = places[agent, sample, 0] - reference[sample, 0]
            dy = places[agent, sample, 1] - reference[sample, 1]
            sums[agent] += math.sqrt(dx * dx + dy * dy)
    return sums
