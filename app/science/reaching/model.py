"""The model: a person's level, and suitability maps of single reaches relative to it.

A simulated person has a level drawn once. For each movement tempo and skew are drawn from the
blended map of recorded reaches of similar distance (and difficulty, if widths are known), after
Agethen, Gaisbauer and Rukzio (2018), "A Probabilistic Steering Parameter Model for Deterministic
Motion Planning Algorithms", section 6, which proposes this for reaching.
"""

from dataclasses import dataclass, field, replace
from math import exp

import numpy as np

from app.science.reaching.database import dependencies_of, log_tempos_of
from app.science.reaching.people import Levels, levels_of, relative_to_people
from app.science.reaching.records import DIFFICULTY, USUAL_NEAR_M
from app.science.reaching.segmentation import ReachRules
from app.science.rotations import FloatArray
from app.science.simulation import usual_time_s
from app.science.walking.maps import (
    ENTRIES,
    TIME_AWARE,
    BlendingSpace,
    SuitabilityOptions,
    WalkDatabase,
)
from app.science.walking.models import MixtureSampler, density_of, ranked_readings, space_of

READINGS: tuple[SuitabilityOptions, ...] = (
    TIME_AWARE,
    *(
        SuitabilityOptions(normalisation="min-max", power=64.0, time_constant_s=64.0 * tau_s)
        for tau_s in (0.1, 0.05, 0.025)
    ),
)
"""The readings of maps that are compared: all are time-aware, since reaches last about a second.

The power tells skews apart, which change the deviation little; it divides the time constant, too.
Without it a slower agent with a longer tail, of which the cut leaves as much, is as suitable.
"""

REACH_NEIGHBOURS = 2000
"""Default number of neighbours, of 5000 entries: there are far fewer reaches than walks, and a
hundred entries would be blends of two or three of them."""
LEAST_PEOPLE = 3
"""Fewest people of whom one can be left out, since two are needed to learn how people differ."""


@dataclass(frozen=True)
class ReachFitOptions:
    """Options for fitting.

    Attributes:
        seed: of blends and folds; the same seed gives the same model.
        k: number of neighbours.
        entries: number of entries of the densified space.
    """

    seed: int = 1
    k: int = REACH_NEIGHBOURS
    entries: int = ENTRIES


@dataclass(frozen=True, eq=False)
class FittedReaching:
    """How people reach, as it was learnt; `ReachingPeople` of the simulation.

    Attributes:
        database: the reaches, with maps of the simulation's assumed time.
        rules: how recordings were cut.
        options: the options as given.
        levels: how people differ.
        reading: how maps become suitability.
        space: maps relative to people's levels, blended.
        content_hash: of the file that it is from, empty if it is from none.
    """

    database: WalkDatabase
    rules: ReachRules
    options: ReachFitOptions
    levels: Levels
    reading: SuitabilityOptions
    space: BlendingSpace
    content_hash: str = ""

    @property
    def persons(self) -> int:
        """The number of people."""
        return len(self.levels.names)

    @property
    def synthetic(self) -> int:
        """How many of the reaches a program made."""
        return sum(kind == "synthetic" for kind in self.database.kinds)

    @property
    def by_width(self) -> bool:
        """Whether the targets' widths are known, and difficulty matters."""
        return DIFFICULTY in self.database.names

    @property
    def distances_m(self) -> tuple[float, float]:
        """The smallest and the largest distance of a reach."""
        lengths_m = self.database.lengths_m
        return float(lengths_m.min()), float(lengths_m.max())

    def outside(self, distance_m: float) -> bool:
        """Return whether a distance is outside of those that were recorded."""
        least_m, most_m = self.distances_m
        return not least_m - 1e-9 <= distance_m <= most_m + 1e-9

    def person(self, rng: np.random.Generator) -> "FittedPerson":
        """Draw one person."""
        return FittedPerson(self, float(self.levels.draw(1, rng)[0]))

    def movements(
        self, distance_m: float, near_m: float, count: int, rng: np.random.Generator
    ) -> tuple[FloatArray, FloatArray]:
        """Draw whole times (count,) and skews (count,), each of somebody new."""
        levels = self.levels.draw(count, rng)
        drawn = density_of(self.space, self.place(distance_m, near_m)).draw(count, rng)
        tempos, skews = np.exp(drawn + levels[:, None] * (1.0, 0.0)).T
        return self.usual_s(distance_m, near_m) * tempos, skews

    def place(self, distance_m: float, near_m: float) -> FloatArray:
        """Return the z-scores (m,) of a movement in the space of dependencies."""
        names = self.database.names
        return self.space.scaling.z(dependencies_of(distance_m, near_m, names))

    def usual_s(self, distance_m: float, near_m: float) -> float:
        """Return the time to which tempos refer.

        Without widths the recorded targets count as usual ones, and so do those of a query.
        """
        return usual_time_s(distance_m, near_m if self.by_width else USUAL_NEAR_M)


@dataclass
class FittedPerson:
    """One person drawn from a model; counts their movements.

    Attributes:
        model: the model.
        level: logarithm of their tempo.
    """

    model: FittedReaching
    level: float
    _drawn: int = 0
    _outside: int = 0
    _sampler: MixtureSampler = field(init=False)

    def __post_init__(self) -> None:
        """Prepare the draws."""
        self._sampler = MixtureSampler(self.model.space)

    @property
    def counts(self) -> tuple[int, int]:
        """How many movements were drawn, and how many of them outside the recorded distances."""
        return self._drawn, self._outside

    def movement(
        self, distance_m: float, near_m: float, rng: np.random.Generator
    ) -> tuple[float, float]:
        """Draw a movement to a target of this half width: its time in seconds, and its skew."""
        model = self.model
        self._drawn += 1
        self._outside += model.outside(distance_m)
        log_tempo, log_skew = self._sampler.draw_one(model.place(distance_m, near_m), rng).tolist()
        return exp(self.level + log_tempo) * model.usual_s(distance_m, near_m), exp(log_skew)


def fitted_reaching(
    database: WalkDatabase, rules: ReachRules, options: ReachFitOptions = ReachFitOptions()
) -> FittedReaching:
    """Fit how people reach to a database of reaches.

    The reading of the maps is chosen by leaving people out, or recordings if there are fewer than
    `LEAST_PEOPLE` people; the time-aware reading is used if there is only one recording, too.
    """
    levels = levels_of(log_tempos_of(database), database.lengths_m, database.subjects)
    relative = relative_to_people(database, levels)
    seeds = np.random.default_rng(options.seed).spawn(2)
    groups = groups_of(database)
    reading = TIME_AWARE
    if len(set(groups)) > 1:
        compared = replace(relative, subjects=groups)
        settings = {"entries": options.entries, "k": options.k}
        reading = ranked_readings(compared, seeds[0], readings=READINGS, **settings)[0].options
    return restored_reaching(database, rules, options, reading)


def restored_reaching(
    database: WalkDatabase,
    rules: ReachRules,
    options: ReachFitOptions,
    reading: SuitabilityOptions,
    content_hash: str = "",
) -> FittedReaching:
    """Rebuild a model from its stored parts; the same seed gives the same blends."""
    levels = levels_of(log_tempos_of(database), database.lengths_m, database.subjects)
    relative = relative_to_people(database, levels)
    seed = np.random.default_rng(options.seed).spawn(2)[1]
    space = space_of(relative, reading, seed, entries=options.entries, k=options.k)
    return FittedReaching(database, rules, options, levels, reading, space, content_hash)


def groups_of(database: WalkDatabase) -> tuple[str, ...]:
    """Return what is left out with each reach: its person, or its recording with few people."""
    return database.subjects if len(database.persons) >= LEAST_PEOPLE else database.sources
