"""Repeat the paper's experiments on one synthetic population, for comparison with its tables.

The population is the one most like the paper's people. Its workplaces are predicted with two
readings of the maps: the paper's, and the one that was chosen on the training people.
"""

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from app.science.walking.evaluation import (
    Evaluation,
    LeftOut,
    evaluate,
    neighbours_left_out,
    nodes_left_out,
    people_left_out,
)
from app.science.walking.maps import PAPER, MapMaker
from app.science.walking.models import (
    FitOptions,
    FittedWalking,
    ProbabilisticModel,
    density_of,
    fitted,
    iqr,
    space_of,
)
from app.science.walking.records import LENGTH, PAPER_GRID, PAPER_PARAMETERS, STATURE, ParameterGrid
from app.science.walking.scene import straight_scene
from app.science.walking.synthetic import POPULATIONS, Sample, synthetic_walks
from tests.benchmarks.walking_ablation import NEIGHBOURS
from tests.benchmarks.walking_cells import FOLLOWER, Studied, made
from tests.science.walking.submodels import with_fixed_parameter, without_dependency

DISTANCES_M, LONG_PEOPLE, LONG_TIMES = (10.0, 25.0, 50.0), 16, 4


@dataclass(frozen=True)
class Neighbourhood:
    """The results for one number k of neighbours.

    Median |dt| of single draws, CRPS, and the duration of one draw by the paper's method.
    """

    k: int
    median_s: float
    crps_s: float
    draw_us: float


@dataclass(frozen=True)
class Submodel:
    """The results of P_prob without one parameter: median |dt| of single draws, and CRPS."""

    without: str
    median_s: float
    crps_s: float


@dataclass(frozen=True)
class LongWalk:
    """Medians and interquartile ranges of travel times over a long distance."""

    distance_m: float
    reference_s: tuple[float, float]
    prob_s: tuple[float, float]
    stat_s: float


@dataclass(frozen=True, eq=False)
class Replication:
    """The results for every table and figure of the paper."""

    studied: Studied
    papers: FittedWalking
    by_papers_reading: tuple[Evaluation, Evaluation]
    neighbours: LeftOut
    nodes: LeftOut
    people: LeftOut
    sweep: tuple[Neighbourhood, ...]
    submodels: tuple[Submodel, ...]
    long_walks: tuple[LongWalk, ...]


def replication(studied: Studied) -> Replication:
    """Repeat the paper's experiments and return all results."""
    rng = np.random.default_rng(11)
    database, fit = studied.database, studied.fit
    papers = fitted(database, replace(fit.options, reading=PAPER))
    one, two = studied.workplaces
    people = people_left_out(database, PAPER, rng, entries=5000, k=100)
    return Replication(
        studied,
        papers,
        (evaluate(papers.models, FOLLOWER, one, rng), evaluate(papers.models, FOLLOWER, two, rng)),
        neighbours_left_out(papers.space),
        nodes_left_out(papers.space, rng),
        people,
        tuple(_sweep(studied, rng)),
        tuple(_submodels(studied, rng)),
        tuple(_long_walks(rng)),
    )


def _sweep(studied: Studied, rng: np.random.Generator) -> Iterator[Neighbourhood]:
    walks = studied.workplaces[0]
    for k in NEIGHBOURS:
        space = replace(studied.fit.space, k=k)
        result = evaluate([ProbabilisticModel(space)], FOLLOWER, walks, rng)
        asked = space.scaling.z(studied.database.vectors[:100])
        density_of(space, asked[0], "radial").draw_by_rejection(1, rng)
        took = []
        for z in asked:
            began = time.perf_counter_ns()
            density_of(space, z, "radial").draw_by_rejection(1, rng)
            took.append(time.perf_counter_ns() - began)
        crps_s = result.outcomes["prob"].mean_crps_s
        yield Neighbourhood(k, result.errors("prob").median_s, crps_s, float(np.median(took)) / 1e3)


def _submodels(studied: Studied, rng: np.random.Generator) -> Iterator[Submodel]:
    fit, walks = studied.fit, studied.workplaces[0]
    static = zip(fit.database.grid.parameters, fit.static.vector, strict=True)
    cut = [("nothing", fit.database)]
    cut += [(name, without_dependency(fit.database, name)) for name in fit.database.names]
    cut += [
        (one.name, with_fixed_parameter(fit.database, one.name, float(value)))
        for one, value in static
    ]
    for name, database in cut:
        space = space_of(database, fit.reading, np.random.default_rng(1))
        result = evaluate([ProbabilisticModel(space)], FOLLOWER, walks, rng)
        yield Submodel(name, result.errors("prob").median_s, result.outcomes["prob"].mean_crps_s)


def _long_walks(rng: np.random.Generator) -> Iterator[LongWalk]:
    """Compare velocity and acceleration by stature and distance, fitted on half the people."""
    values = (*PAPER_GRID.values[:2], (2.0,))
    maker = MapMaker(grid=ParameterGrid(PAPER_PARAMETERS, values))
    scenes = [straight_scene(distance) for distance in DISTANCES_M]
    walks = list(synthetic_walks(POPULATIONS[0], scenes, Sample(LONG_PEOPLE, LONG_TIMES, 77)))
    names = sorted({entry.walk.subject for entry in walks})
    known = set(names[: LONG_PEOPLE // 2])
    database = made([e for e in walks if e.walk.subject in known], maker, (LENGTH, STATURE))
    fit = fitted(database, FitOptions(seed=5))
    others = [entry for entry in walks if entry.walk.subject not in known]
    result = evaluate([fit.stat, fit.prob], FOLLOWER, others, rng)
    for scene, distance in zip(scenes, DISTANCES_M, strict=True):
        own = np.array([course.startswith(f"{scene.name}:") for course in result.courses])
        truth, drawn = result.truth_s[own], result.outcomes["prob"].draws_s[own].ravel()
        yield LongWalk(
            distance,
            (float(np.median(truth)), iqr(truth)),
            (float(np.median(drawn)), iqr(drawn)),
            float(np.median(result.outcomes["stat"].draws_s[own])),
        )
