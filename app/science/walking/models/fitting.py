"""Fit the static, the adaptive and the probabilistic model to a database."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.science.walking.maps import (
    ENTRIES,
    NEIGHBOURS,
    TIME_AWARE,
    BlendingSpace,
    SuitabilityOptions,
    WalkDatabase,
    blending_space,
    check_persons,
)
from app.science.walking.models.annealing import StaticFit, static_fit
from app.science.walking.models.reading_choice import READINGS, ReadingScore, ranked_readings
from app.science.walking.models.steering_models import (
    AdaptiveModel,
    ProbabilisticModel,
    StaticModel,
    SteeringModel,
)
from app.science.walking.records import scaling_of

LEAST_TO_CHOOSE = 8
"""Fewest people from which a reading is chosen; below, the time-aware reading is used."""


@dataclass(frozen=True)
class FitOptions:
    """Options for fitting a model; the defaults are the paper's, except for the reading.

    Attributes:
        seed: the seed of the blends, the folds and the annealing; the same seed gives the same
            model.
        k: number of neighbours.
        entries: the number of entries of the densified space.
        reading: the reading of maps as suitability; None to choose it by leaving people out,
            if there are at least `LEAST_TO_CHOOSE` of them.
    """

    seed: int = 1
    k: int = NEIGHBOURS
    entries: int = ENTRIES
    reading: SuitabilityOptions | None = None


@dataclass(frozen=True, eq=False)
class FittedWalking:
    """The three models fitted to a database.

    Attributes:
        database: the walks they were fitted to.
        options: the options as given.
        reading: the reading that was chosen, or given.
        scores: the scores of all readings that were compared, best first; empty if none were.
        space: the space of P_adapt and P_prob.
        static: P_stat.
    """

    database: WalkDatabase
    options: FitOptions
    reading: SuitabilityOptions
    scores: tuple[ReadingScore, ...]
    space: BlendingSpace
    static: StaticFit

    @property
    def stat(self) -> StaticModel:
        """The static model, P_stat."""
        return StaticModel(self.static.vector)

    @property
    def adapt(self) -> AdaptiveModel:
        """The adaptive model, P_adapt."""
        return AdaptiveModel(self.space)

    @property
    def prob(self) -> ProbabilisticModel:
        """The probabilistic model, P_prob."""
        return ProbabilisticModel(self.space)

    @property
    def models(self) -> tuple[SteeringModel, ...]:
        """All three models, in the paper's order."""
        return self.stat, self.adapt, self.prob


def fitted(
    database: WalkDatabase,
    options: FitOptions = FitOptions(),
    readings: Sequence[SuitabilityOptions] = READINGS,
) -> FittedWalking:
    """Fit all three models; raise WalkingError if all walks are of one person."""
    check_persons(database)
    seeds = np.random.default_rng(options.seed).spawn(3)
    scores: tuple[ReadingScore, ...] = ()
    reading = options.reading
    if reading is None and len(database.persons) < LEAST_TO_CHOOSE:
        reading = TIME_AWARE
    if reading is None:
        ranked = ranked_readings(
            database, seeds[0], readings=readings, entries=options.entries, k=options.k
        )
        scores, reading = tuple(ranked), ranked[0].options
    space = space_of(database, reading, seeds[1], entries=options.entries, k=options.k)
    static = static_fit(database, seeds[2])
    return FittedWalking(database, options, reading, scores, space, static)


def restored(
    database: WalkDatabase,
    options: FitOptions,
    reading: SuitabilityOptions,
    scores: Sequence[ReadingScore],
    static: StaticFit,
) -> FittedWalking:
    """Rebuild a fitted model from its stored parts; the same seed gives the same blends."""
    seed = np.random.default_rng(options.seed).spawn(3)[1]
    space = space_of(database, reading, seed, entries=options.entries, k=options.k)
    return FittedWalking(database, options, reading, tuple(scores), space, static)


def space_of(
    database: WalkDatabase,
    reading: SuitabilityOptions,
    rng: np.random.Generator,
    *,
    entries: int = ENTRIES,
    k: int = NEIGHBOURS,
) -> BlendingSpace:
    """Return the densified space of a database for one reading."""
    scaling = scaling_of(database.names, database.vectors)
    values = database.suitability(reading)
    return blending_space(
        database.grid, scaling, database.vectors, values, rng=rng, entries=entries, k=k
    )
