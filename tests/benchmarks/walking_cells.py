"""Evaluate all three models on all populations, to judge the walking model.

Each population has a database of 24 people in the laboratory's sixteen scenes. A cell is a
population in one of three situations, and no person is in both training and test data:

    laboratory    people left out of the database, a quarter at a time

    workplace 1   ten other people in the paper's first scene, which is not in the database

    workplace 2   the same people in its second scene

Readings are chosen on the people on whom a model is fitted.
"""

import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from app.adapters.walks.scene_file import load_shipped
from app.science.walking.evaluation import Evaluation, evaluate, pooled
from app.science.walking.following import SteeringFollower
from app.science.walking.maps import MapMaker, WalkDatabase, database_of, maps_of
from app.science.walking.models import FitOptions, FittedWalking, fitted, person_folds
from app.science.walking.records import LENGTH, STATURE, TURNING, PlannedWalk
from app.science.walking.scene import Scene
from app.science.walking.synthetic import (
    POPULATIONS,
    Population,
    Sample,
    laboratory_scenes,
    synthetic_walks,
)

NAMES = (LENGTH, TURNING, STATURE)
PEOPLE, FOLDS, OTHERS, REPETITIONS = 24, 4, 10, 2
FOLLOWER = SteeringFollower()
SCENES = ("car-and-three-racks", "car-between-two-racks")


@dataclass(frozen=True, eq=False)
class Cell:
    """A population in one of the three situations, with its walks."""

    population: str
    situation: str
    evaluation: Evaluation


@dataclass(frozen=True, eq=False)
class Studied:
    """One population: its database, the model fitted on all of it, and its cells.

    Attributes:
        workplaces: walks of other people in the two workplace scenes.
    """

    population: Population
    entries: list[PlannedWalk]
    database: WalkDatabase
    fit: FittedWalking
    workplaces: tuple[list[PlannedWalk], list[PlannedWalk]]
    cells: tuple[Cell, ...]


def made(entries: Sequence[PlannedWalk], maker: MapMaker, names: tuple[str, ...]) -> WalkDatabase:
    """Return a database of walks, with maps of all its entries."""
    return database_of(entries, [one for _, one in maps_of(entries, maker)], names)


def people_of_laboratory(population: Population, seed: int) -> list[PlannedWalk]:
    """Return the walks of the people of a database, in the laboratory's sixteen scenes."""
    return list(synthetic_walks(population, laboratory_scenes(), Sample(PEOPLE, seed=seed)))


def people_of_workplace(population: Population, scene: Scene, seed: int) -> list[PlannedWalk]:
    """Return the walks of other people on all paths of a scene."""
    sample = Sample(OTHERS, REPETITIONS, seed=1000 + seed, prefix="other ")
    return list(synthetic_walks(population, [scene], sample))


@cache
def studied() -> tuple[Studied, ...]:
    """Compute the results for all populations, once per process; this takes some minutes."""
    return tuple(_study(population, seed) for seed, population in enumerate(POPULATIONS, start=1))


def _study(population: Population, seed: int) -> Studied:
    began = time.perf_counter()
    entries = people_of_laboratory(population, seed)
    database = made(entries, MapMaker(), NAMES)
    fit = fitted(database, FitOptions(seed=seed))
    one, two = (people_of_workplace(population, load_shipped(key), seed) for key in SCENES)
    rng = np.random.default_rng(seed)
    cells = [
        Cell(population.name, "laboratory", _left_out(entries, database, seed, rng)),
        Cell(population.name, "workplace 1", evaluate(fit.models, FOLLOWER, one, rng)),
        Cell(population.name, "workplace 2", evaluate(fit.models, FOLLOWER, two, rng)),
    ]
    took = time.perf_counter() - began
    print(f"  {population.name}: {len(entries)} walks, {took:.0f} s", file=sys.stderr)
    return Studied(population, entries, database, fit, (one, two), tuple(cells))


def _left_out(
    entries: list[PlannedWalk], database: WalkDatabase, seed: int, rng: np.random.Generator
) -> Evaluation:
    parts = []
    for fold in person_folds(database, rng, FOLDS):
        out = database.walked_by(fold)
        fit = fitted(database.select(~out), FitOptions(seed=seed))
        assert not set(fit.database.subjects) & set(fold)
        left = [entries[at] for at in np.flatnonzero(out)]
        parts.append(evaluate(fit.models, FOLLOWER, left, rng))
    return pooled(parts)
