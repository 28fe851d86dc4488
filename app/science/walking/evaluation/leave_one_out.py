"""Measure how well maps are interpolated, by leaving out entries, people or nodes.

Over dependencies maps are interpolated by neighbours, between nodes by radial basis functions. As
in the paper, one entry of the densified space is left out and estimated from its neighbours; the
median over the nodes of estimate minus truth is one value, and mean and standard deviation are over
all entries. The blends of the entry are still present, and it may be a blend of others itself, so
this measures how smooth the space is and not how well a new person is predicted. The latter is
`people_left_out`, and how well travel times are predicted is `times_left_out`.
"""

from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.evaluation.scoring import over_people, reason_for_no_interval
from app.science.walking.maps import (
    BlendingSpace,
    IntArray,
    SuitabilityOptions,
    WalkDatabase,
    neighbours,
    radial_basis,
)
from app.science.walking.models import (
    MIXED,
    covers,
    crps_s,
    each_left_out,
    person_folds,
    space_of,
    timed_walks_of,
)
from app.science.walking.travel_times import (
    BASELINES,
    Curve,
    StartingAndStopping,
    TimedWalks,
    posterior_of,
)

NODES = 100
"""Random nodes of each map at which the radial basis is evaluated."""


@dataclass(frozen=True)
class LeftOut:
    """Deviations of estimated suitability, in percent of its range.

    Attributes:
        mean, sd: mean and standard deviation over the entries.
        entries: number of entries.
    """

    mean: float
    sd: float
    entries: int


def neighbours_left_out(space: BlendingSpace) -> LeftOut:
    """Leave out each entry in turn and estimate its map from its k nearest other entries."""
    from app.science.walking.models.sampling_kernels import blend_rows

    count = len(space.z)
    k = min(space.k, count - 1)
    medians = np.empty(count)
    for at in range(count):
        indices, _ = neighbours(space.tree, space.z[at], k + 1)
        others = indices[indices != at][:k]
        guess = blend_rows(others, _weights(space.z, others, at), space.values)
        medians[at] = np.median(guess - space.values[at])
    return _summary(medians)


def _weights(z: FloatArray, others: IntArray, at: int) -> FloatArray:
    apart = np.linalg.norm(z[others] - z[at], axis=1)
    weights = 1.0 - apart / apart.max() if apart.max() > 0.0 else np.ones(len(apart))
    total = weights.sum()
    found: FloatArray = weights / total if total > 0.0 else np.full(len(apart), 1 / len(apart))
    return found


def people_left_out(
    database: WalkDatabase,
    reading: SuitabilityOptions,
    rng: np.random.Generator,
    *,
    entries: int,
    k: int,
    folds: int = 4,
) -> LeftOut:
    """Estimate each walk's map from the densified maps of other people."""
    from app.science.walking.models.sampling_kernels import blend_rows

    values, medians = database.suitability(reading), []
    for fold in person_folds(database, rng, folds):
        out = database.walked_by(fold)
        space = space_of(database.select(~out), reading, rng, entries=entries, k=k)
        for at in np.flatnonzero(out):
            indices, weights = space.neighbours(space.scaling.z(database.vectors[at]))
            guess = blend_rows(indices, weights, space.values)
            medians.append(float(np.median(guess - values[at])))
    return _summary(np.array(medians))


def nodes_left_out(space: BlendingSpace, rng: np.random.Generator) -> LeftOut:
    """Leave nodes out of each map and estimate them from the others by radial basis functions."""
    basis = radial_basis(space.grid)
    medians = np.empty(len(space.values))
    for first in range(0, len(space.values), 512):
        part = slice(first, first + 512)
        errors = basis.leave_one_out(space.values[part].astype(np.float64))
        tried = rng.integers(0, space.grid.size, size=(len(errors), NODES))
        medians[part] = -np.median(np.take_along_axis(errors, tried, axis=1), axis=1)
    return _summary(medians)


def _summary(medians: FloatArray) -> LeftOut:
    return LeftOut(100.0 * float(medians.mean()), 100.0 * float(medians.std()), len(medians))


@dataclass(frozen=True)
class TimesLeftOut:
    """How well travel times of people who were left out are predicted.

    Attributes:
        method: "mixed", a baseline, or "mixed without" a further dependency that a user named.
        crps_s: mean CRPS over the walks.
        crps_less_s: how much smaller the CRPS of P_mixed is, and the ends of its 95 % interval over
            people, which are None with fewer than six people; all zero for P_mixed itself.
        coverage_50, coverage_90: shares of walks inside the central 50 and 90 % of predictions.
        walks, people: their numbers.
    """

    method: str
    people: int
    walks: int
    crps_s: float
    coverage_50: float
    coverage_90: float
    crps_less_s: tuple[float, float | None, float | None]


def times_left_out(
    database: WalkDatabase, rng: np.random.Generator, *, folds: int = 4, draws: int = 400
) -> list[TimesLeftOut]:
    """Predict travel times of people left out, by P_mixed and the baselines learnt from the others.

    P_mixed without each of the walks' further dependencies is one more baseline: they are worth
    having if it does worse.

    Empty if there are fewer than three people, since two are needed to learn from, or if the
    database does not say which walks the recording cut off.
    """
    if database.resting is None or len(database.persons) < 3:
        return []
    walks, _ = timed_walks_of(database)
    parts = [database.walked_by(fold) for fold in person_folds(database, rng, folds)]
    if any(len(set(np.array(database.subjects)[~out])) < 2 for out in parts):
        return []
    compared: list[tuple[str, Curve, TimedWalks]] = [(MIXED, StartingAndStopping(), walks)]
    compared += [(curve.name, curve, walks) for curve in BASELINES]
    for name, plain in each_left_out(database):
        compared.append((name, StartingAndStopping(), timed_walks_of(plain)[0]))
    scores: dict[str, FloatArray] = {}
    for method, curve, timed in compared:
        rows = np.empty((len(walks), 3))
        for out in parts:
            learnt = posterior_of(timed.select(~out), curve, rng)
            for at in np.flatnonzero(out):
                drawn = learnt.draw(timed.select(np.array([at])), draws, rng)[0]
                truth = float(walks.durations_s[at])
                rows[at] = (
                    crps_s(drawn, truth),
                    covers(drawn, truth, 0.5),
                    covers(drawn, truth, 0.9),
                )
        scores[method] = rows
    ours = scores[MIXED][:, 0]
    found = []
    for name, rows in scores.items():
        less = rows[:, 0] - ours
        interval = (
            (None, None)
            if reason_for_no_interval(len(walks.persons))
            else over_people(less, walks.subjects, np.random.default_rng(1))
        )
        score_s, half, most = (float(value) for value in rows.mean(axis=0))
        found.append(
            TimesLeftOut(
                name,
                len(walks.persons),
                len(walks),
                score_s,
                half,
                most,
                (float(less.mean()), *interval),
            )
        )
    return found
