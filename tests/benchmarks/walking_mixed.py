"""Predict synthetic walkers with P_mixed, beside baselines that learn from the same walks.

For `./run bench walking_evaluation --only mixed`. The walkers, paths and people left out are those
of `walking_cells`. Travel-time models need no maps, so that the coarsest ones serve. Synthetic
walkers speed up and brake by rules of their own: what this shows is whether effects of people and
the spread of walks are learnt where they are known to be of a certain kind, not how people walk.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from app.adapters.walks.scene_file import load_shipped
from app.science.walking.evaluation import Evaluation, evaluate, pooled
from app.science.walking.maps import MapMaker, WalkDatabase
from app.science.walking.models import MIXED, baseline_models, person_folds, travel_time_model
from app.science.walking.records import PAPER_PARAMETERS, PlannedWalk, regular_grid
from app.science.walking.synthetic import POPULATIONS, Population
from tests.benchmarks.walking_cells import (
    FOLDS,
    FOLLOWER,
    NAMES,
    SCENES,
    made,
    people_of_laboratory,
    people_of_workplace,
)

DRAWS = 1000
COARSEST = regular_grid(PAPER_PARAMETERS, 3)


@dataclass(frozen=True, eq=False)
class MixedCell:
    """A population in one of the three situations, predicted by P_mixed and the baselines."""

    population: str
    situation: str
    evaluation: Evaluation

    @property
    def best_baseline(self) -> str:
        """The baseline with the smallest CRPS on these walks."""
        names = [name for name in self.evaluation.outcomes if name != MIXED]
        return min(names, key=lambda name: self.evaluation.outcomes[name].mean_crps_s)

    def as_json(self) -> dict[str, object]:
        """Return the figures of the benchmark's JSON; coverage in percent."""
        found, best = self.evaluation, self.best_baseline
        half, most = found.coverage(MIXED)
        less_s, low_s, high_s = found.better_by_s(best, MIXED, np.random.default_rng(1))
        return {
            "population": self.population,
            "situation": self.situation,
            "walks": len(found.truth_s),
            "people": found.people,
            "crps_s": {name: one.mean_crps_s for name, one in found.outcomes.items()},
            "best_baseline": best,
            "mixed_less_best_s": less_s,
            "mixed_less_best_95_s": [low_s, high_s],
            "coverage_50": 100.0 * half,
            "coverage_90": 100.0 * most,
        }


@cache
def mixed_cells() -> tuple[MixedCell, ...]:
    """Compute all cells, once per process; takes about a minute."""
    return tuple(
        cell
        for seed, population in enumerate(POPULATIONS, start=1)
        for cell in _cells(population, seed)
    )


def _cells(population: Population, seed: int) -> Sequence[MixedCell]:
    rng = np.random.default_rng(seed)
    entries = people_of_laboratory(population, seed)
    database = made(entries, MapMaker(grid=COARSEST), NAMES)
    parts = []
    for fold in person_folds(database, rng, FOLDS):
        out = database.walked_by(fold)
        left = [entries[at] for at in np.flatnonzero(out)]
        parts.append(_evaluated(database.select(~out), left, rng))
    found = [MixedCell(population.name, "laboratory", pooled(parts))]
    for number, scene in enumerate(map(load_shipped, SCENES), start=1):
        walks = people_of_workplace(population, scene, seed)
        name = f"workplace {number}"
        found.append(MixedCell(population.name, name, _evaluated(database, walks, rng)))
    return found


def _evaluated(
    database: WalkDatabase, walks: Sequence[PlannedWalk], rng: np.random.Generator
) -> Evaluation:
    models = [travel_time_model(database, rng), *baseline_models(database, rng)]
    return evaluate(models, FOLLOWER, walks, rng, draws=DRAWS)
