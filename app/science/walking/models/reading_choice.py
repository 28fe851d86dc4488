"""Choose the reading of maps that predicts best, using the training people only.

Each person is left out in turn (or in groups), and all their walks are predicted from the others'
maps. A walk's own map contains the travel time of every combination on its own path, so no new
simulation is needed: vectors are drawn from the others' blended suitability, and each draw's travel
time is looked up in the walk's map. Between nodes the pace 1 / T is interpolated, which is nearly
linear in speed; combinations that do not arrive have pace 0 and are left out.

Readings are then compared by mean CRPS. People whose walks are predicted later are never involved.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.maps import (
    ENTRIES,
    NEIGHBOURS,
    PAPER,
    TIME_AWARE,
    Axes,
    BlendingSpace,
    IntArray,
    SuitabilityOptions,
    WalkDatabase,
    axes_of,
    blending_space,
    check_persons,
)
from app.science.walking.models.crps import crps_s
from app.science.walking.records import scaling_of

DRAWS = 200
FOLDS = 4
SLOWEST_PACE = 1e-3
"""Pace in 1/s below which an agent counts as not arrived."""
READINGS: tuple[SuitabilityOptions, ...] = (
    PAPER,
    SuitabilityOptions(power=4.0),
    SuitabilityOptions(normalisation="min-max", power=4.0),
    SuitabilityOptions(normalisation="min-max", power=16.0),
    TIME_AWARE,
    SuitabilityOptions(time_constant_s=0.2),
    SuitabilityOptions(time_constant_s=0.05),
    SuitabilityOptions(power=2.0, time_constant_s=0.1),
    SuitabilityOptions(power=4.0, time_constant_s=0.1),
    SuitabilityOptions(normalisation="min-max", power=2.0, time_constant_s=0.1),
)
"""The readings that are compared."""


@dataclass(frozen=True)
class ReadingScore:
    """The score of a reading: how well it predicts the walks of people who were left out.

    Attributes:
        options: the reading.
        crps_s: the mean CRPS over the walks.
    """

    options: SuitabilityOptions
    crps_s: float


def person_folds(
    database: WalkDatabase, rng: np.random.Generator, folds: int = FOLDS
) -> list[tuple[str, ...]]:
    """Divide people into folds of about equal size; all walks of a person are in one fold."""
    check_persons(database)
    shuffled = list(rng.permutation(np.array(database.persons, dtype=object)))
    count = min(folds, len(shuffled))
    return [tuple(str(name) for name in shuffled[at::count]) for at in range(count)]


def ranked_readings(
    database: WalkDatabase,
    rng: np.random.Generator,
    *,
    readings: Sequence[SuitabilityOptions] = READINGS,
    entries: int = ENTRIES,
    k: int = NEIGHBOURS,
) -> list[ReadingScore]:
    """Score readings, best first; raise WalkingError if all walks are of one person."""
    parts = [
        (np.flatnonzero(database.walked_by(fold)), np.flatnonzero(~database.walked_by(fold)))
        for fold in person_folds(database, rng)
    ]
    origins = [
        _origins(database, left_out, training, rng, entries, k) for left_out, training in parts
    ]
    uniforms = rng.random((DRAWS, 1 + 2 * len(database.grid.shape)))
    scores = []
    for options in readings:
        values = database.suitability(options)
        scores_of_walks: list[float] = []
        for (left_out, training), shares in zip(parts, origins, strict=True):
            blended = np.clip(shares.astype(np.float32) @ values[training], 0.0, None)
            scores_of_walks += [
                _score(database, int(at), row, uniforms)
                for at, row in zip(left_out, blended, strict=True)
            ]
        scores.append(ReadingScore(options, float(np.mean(scores_of_walks))))
    return sorted(scores, key=lambda score: score.crps_s)


def _origins(
    database: WalkDatabase,
    left_out: IntArray,
    training: IntArray,
    rng: np.random.Generator,
    entries: int,
    k: int,
) -> FloatArray:
    """Return the share of each training walk in the result for each walk left out.

    The result is (walks left out, training walks).
    """
    scaling = scaling_of(database.names, database.vectors[training])
    # The positions of walks do not depend on their maps, so empty maps are sufficient.
    empty_maps = np.zeros((len(training), database.grid.size), dtype=np.float32)
    space: BlendingSpace = blending_space(
        database.grid,
        scaling,
        database.vectors[training],
        empty_maps,
        rng=rng,
        entries=entries,
        k=k,
    )
    return np.stack([space.origins(z) for z in scaling.z(database.vectors[left_out])])


def _score(database: WalkDatabase, at: int, blended: FloatArray, uniforms: FloatArray) -> float:
    """Return the CRPS of the prediction of one walk by a blended map (K,)."""
    from app.science.walking.maps.interpolation_kernels import multilinear_at
    from app.science.walking.models.sampling_kernels import tent_draws

    axes: Axes = axes_of(database.grid)
    cumulative = np.cumsum(blended.astype(np.float64) * axes.node_weights)
    truth_s = float(database.durations_s[at])
    if not cumulative[-1] > 0.0:
        return truth_s
    vectors = np.empty((len(uniforms), len(axes.shape)))
    tent_draws(cumulative, axes.values, axes.shape, uniforms, vectors)
    arrivals = database.arrivals_s[at].astype(np.float64)
    paces = np.where(np.isfinite(arrivals), 1.0 / arrivals, 0.0)
    arrived_paces = multilinear_at(paces, axes.values, axes.shape, vectors)
    arrived_paces = arrived_paces[arrived_paces > SLOWEST_PACE]
    return crps_s(1.0 / arrived_paces, truth_s) if len(arrived_paces) else truth_s
