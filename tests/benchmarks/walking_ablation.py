"""Leave out each parameter, and vary the number of neighbours, where walks turn and where not.

The other people's walks at both workplaces are predicted by P_prob with and without each
dependency and steering parameter, in every population. What a parameter is worth is the increase
of CRPS without it, over all these walks and over those that turn by at least TURNS_RAD_PER_M: on a
straight path the turning is zero and the angular velocity has no effect, so only the latter can say
anything about curvature. Intervals draw whole people again.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from app.science.walking.evaluation import Evaluation, evaluate, over_people
from app.science.walking.maps import WalkDatabase
from app.science.walking.models import ProbabilisticModel, space_of
from app.science.walking.records import TURNING
from tests.benchmarks.walking_cells import FOLLOWER, Studied, studied
from tests.science.walking.submodels import with_fixed_parameter, without_dependency

NEIGHBOURS = (10, 20, 50, 100, 200, 500)
TURNS_RAD_PER_M = 0.3
SETS = ("all walks", f"turning by {TURNS_RAD_PER_M:g} rad/m or more")


@dataclass(frozen=True)
class Worth:
    """What a parameter is worth in a population, on one set of walks.

    Attributes:
        gain_s: increase of the mean CRPS without it, with a 95 % interval over people.
        share: the same, of the CRPS with all parameters.
    """

    parameter: str
    gain_s: float
    low_s: float
    high_s: float
    share: float

    @property
    def helps(self) -> bool:
        """Return whether predictions get worse without it by more than the interval."""
        return self.low_s > 0.0


@dataclass(frozen=True)
class Ablation:
    """The results for one population and set of walks.

    Attributes:
        walks, people: how many there are.
        crps_s: mean CRPS with all parameters.
        parts: what each parameter is worth.
        by_k: mean CRPS by the number of neighbours.
    """

    population: str
    walks_set: str
    walks: int
    people: int
    crps_s: float
    parts: tuple[Worth, ...]
    by_k: dict[int, float]

    @property
    def best_k(self) -> int:
        """Return the number of neighbours with the smallest CRPS."""
        return min(self.by_k, key=lambda k: self.by_k[k])


@cache
def ablations() -> tuple[Ablation, ...]:
    """Return the results for all populations and sets, computed once per process."""
    return tuple(
        one
        for seed, population in enumerate(studied(), start=1)
        for one in _ablations(population, np.random.default_rng(100 + seed))
    )


def of_set(found: Sequence[Ablation], walks_set: str) -> list[Ablation]:
    """Return the results of all populations for one set of walks."""
    return [one for one in found if one.walks_set == walks_set]


def _ablations(one: Studied, rng: np.random.Generator) -> Iterator[Ablation]:
    walks = [walk for workplace in one.workplaces for walk in workplace]
    turning = np.array([walk.dependencies[TURNING] for walk in walks]) >= TURNS_RAD_PER_M

    def predicted(database: WalkDatabase, k: int | None = None) -> Evaluation:
        space = space_of(database, one.fit.reading, np.random.default_rng(1))
        model = ProbabilisticModel(space if k is None else replace(space, k=k))
        found = evaluate([model], FOLLOWER, walks, rng)
        assert not found.left_out
        return found

    whole = predicted(one.database)
    cut = {name: predicted(database) for name, database in _without(one)}
    by_k = {k: predicted(one.database, k) for k in NEIGHBOURS}
    for walks_set, chosen in zip(SETS, (np.ones(len(walks), np.bool_), turning), strict=True):
        subjects = [whole.subjects[at] for at in np.flatnonzero(chosen)]
        before_s = _crps_s(whole)[chosen]
        parts = []
        for name, found in cut.items():
            gain_s = _crps_s(found)[chosen] - before_s
            low_s, high_s = over_people(gain_s, subjects, rng)
            share = float(gain_s.mean() / before_s.mean())
            parts.append(Worth(name, float(gain_s.mean()), low_s, high_s, share))
        yield Ablation(
            one.population.name,
            walks_set,
            len(subjects),
            len(set(subjects)),
            float(before_s.mean()),
            tuple(parts),
            {k: float(_crps_s(found)[chosen].mean()) for k, found in by_k.items()},
        )


def _without(one: Studied) -> Iterator[tuple[str, WalkDatabase]]:
    """Yield the database without each dependency, then with each steering parameter fixed."""
    for name in one.database.names:
        yield name, without_dependency(one.database, name)
    fixed = zip(one.database.grid.parameters, one.fit.static.vector, strict=True)
    for parameter, value in fixed:
        yield parameter.name, with_fixed_parameter(one.database, parameter.name, float(value))


def _crps_s(found: Evaluation) -> NDArray[np.float64]:
    return found.outcomes["prob"].crps_s
