"""Fit the static, the adaptive and the probabilistic model to a database."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

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
from app.science.walking.models.prediction import slowest_s
from app.science.walking.models.reading_choice import READINGS, ReadingScore, ranked_readings
from app.science.walking.models.steering_models import (
    AdaptiveModel,
    ProbabilisticModel,
    StaticModel,
    SteeringModel,
)
from app.science.walking.models.travel_time_model import (
    MIXED,
    TravelTimeModel,
    other_scaling,
    travel_time_model,
)
from app.science.walking.recording import FASTEST_M_S
from app.science.walking.records import LENGTH, WalkingError, scaling_of
from app.science.walking.travel_times import Posterior

LEAST_TO_CHOOSE = 8
"""Fewest people from which a reading is chosen; below, the time-aware reading is used."""


_DRAWS = 200


class NobodyWalks(WalkingError):
    """Numbers that are far outside those of a model's walks: it would predict what nobody does."""


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
    """The paper's three models fitted to a database, and P_mixed where the database carries it.

    Attributes:
        database: the walks they were fitted to.
        options: the options as given.
        reading: the reading that was chosen, or given.
        scores: the scores of all readings that were compared, best first; empty if none were.
        space: the space of P_adapt and P_prob.
        static: P_stat.
        stored: what P_mixed learnt, if it was read from a file; else it is learnt when asked for.
        caveats: sentences on the walks that whoever uses a prediction must know, as that people
            are only told apart by the names of files.
    """

    database: WalkDatabase
    options: FitOptions
    reading: SuitabilityOptions
    scores: tuple[ReadingScore, ...]
    space: BlendingSpace
    static: StaticFit
    stored: Posterior | None = None
    caveats: tuple[str, ...] = ()

    @cached_property
    def mixed(self) -> TravelTimeModel | None:
        """P_mixed; None if the model is from a file that does not say which walks were cut off."""
        if self.database.resting is None:
            return None
        if self.stored is not None:
            return TravelTimeModel(MIXED, self.stored, other_scaling(self.database))
        seed = np.random.default_rng(self.options.seed).spawn(4)[3]
        return travel_time_model(self.database, seed)

    @property
    def usual(self) -> SteeringModel:
        """The model that predictions are made with: P_mixed, or P_prob where there is none."""
        return self.mixed or self.prob

    def named(self, name: str) -> SteeringModel:
        """Return one of the models by its name; raise WalkingError if there is none."""
        found = {model.name: model for model in (self.usual, *self.models)}
        if name not in found:
            raise WalkingError(
                f"There is no model {name!r} in this file, only {', '.join(found)}. A file of an"
                " earlier version has no mixed: fit the walks again."
            )
        return found[name]

    def outside(self, dependencies: Mapping[str, float]) -> list[str]:
        """Return the dependencies outside the range of the walks that the model was fitted to."""
        base = self.database
        return [
            name
            for at, name in enumerate(base.names)
            if not base.vectors[:, at].min() - 1e-9
            <= dependencies[name]
            <= base.vectors[:, at].max() + 1e-9
        ]

    def seen(self, name: str) -> str:
        """Return the range of a dependency in the walks that the model was fitted to."""
        values = self.database.vectors[:, self.database.names.index(name)]
        return f"{values.min():.2f} to {values.max():.2f}"

    def check_walkable(self, dependencies: Mapping[str, float]) -> None:
        """Refuse numbers so far outside those of the model's walks that nobody walks like that.

        Raises:
            NobodyWalks: by the median of `mixed` people are faster or slower than anybody. A model
                without it takes its answer from its nearest walks, which people did walk.
        """
        outside = self.outside(dependencies)
        if not outside or self.mixed is None:
            return
        length_m = dependencies[LENGTH]
        with np.errstate(all="ignore"):
            rng = np.random.default_rng(self.options.seed)
            times_s, _ = self.mixed.agents(length_m, dependencies, _DRAWS, rng)
            median_s = float(np.median(times_s))
            speed_m_s = float(np.divide(length_m, median_s))
        if speed_m_s <= FASTEST_M_S and median_s <= slowest_s(length_m):
            return
        numbers = "; ".join(
            f"{name} is {dependencies[name]:g}, and the model has seen {self.seen(name)}"
            for name in outside
        )
        kind = "faster" if speed_m_s > FASTEST_M_S else "slower"
        raise NobodyWalks(
            f"{numbers}. People would be {kind} than anybody walks: {speed_m_s:.2g} m/s, where"
            f" {length_m / slowest_s(length_m):.2g} to {FASTEST_M_S:g} m/s are possible."
        )

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
        """The paper's three models, in its order."""
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
    stored: Posterior | None = None,
    caveats: Sequence[str] = (),
) -> FittedWalking:
    """Rebuild a fitted model from its stored parts; the same seed gives the same blends."""
    seed = np.random.default_rng(options.seed).spawn(3)[1]
    space = space_of(database, reading, seed, entries=options.entries, k=options.k)
    return FittedWalking(
        database, options, reading, tuple(scores), space, static, stored, tuple(caveats)
    )


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
