"""P_mixed: travel times with effects of people, and agents that take these times.

The paper's models choose among agents whose movements resemble recorded ones, and learn of a person
only what the maps of single walks say. This model learns from the travel times themselves, how they
grow with distance and turning, and how people and single walks differ (`travel_times`). An agent
then gets the pace and the ramp time of a drawn person, and is slowed down or sped up as a whole
until it takes the drawn time: with all speeds multiplied by c and all accelerations by c^2 it walks
the same line in 1 / c of the time.

The same class holds the baselines, which predict times but no agents.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.maps import WalkDatabase
from app.science.walking.records import (
    LENGTH,
    PAPER_PARAMETERS,
    TURNING,
    PlannedPath,
    Scaling,
    WalkingError,
    further_of,
    scaling_of,
)
from app.science.walking.travel_times import (
    BASELINES,
    Curve,
    Posterior,
    StartingAndStopping,
    TimedWalks,
    posterior_of,
    turning_of,
)

MIXED = "mixed"
WITHOUT = f"{MIXED} without "
"""What P_mixed is called without a further dependency, before its name."""
_WIDEST_TURN = PAPER_PARAMETERS[2].high


@dataclass(frozen=True, eq=False)
class TravelTimeModel:
    """A model of travel times; a `SteeringModel` if its curve is that of an agent.

    Attributes:
        name: short key.
        posterior: what was learnt of the curve.
        scaling: of the dependencies besides length and turning; None if there are none.
    """

    name: str
    posterior: Posterior
    scaling: Scaling | None = None
    draws: bool = True

    def durations_s(
        self,
        path: PlannedPath,
        dependencies: Mapping[str, float],
        count: int,
        rng: np.random.Generator,
        *,
        resting: float = 1.0,
    ) -> FloatArray:
        """Draw travel times (count,) of new people; `resting` as in `TimedWalks`."""
        return self._drawn(path.length_m, dependencies, count, rng, resting)[0]

    def vectors(
        self, dependencies: Mapping[str, float], count: int, rng: np.random.Generator
    ) -> FloatArray:
        """Draw agents' vectors (count, 3) for a walk from rest to rest.

        Raises:
            WalkingError: a dependency is missing, or the model is a baseline.
        """
        return self.agents(float(dependencies.get(LENGTH, 1.0)), dependencies, count, rng)[1]

    def agents(
        self,
        length_m: float,
        dependencies: Mapping[str, float],
        count: int,
        rng: np.random.Generator,
        *,
        resting: float = 1.0,
    ) -> tuple[FloatArray, FloatArray]:
        """Draw travel times (count,), and vectors (count, 3) of agents that take about as long."""
        if not isinstance(self.posterior.curve, StartingAndStopping):
            raise WalkingError(f"Model {self.name} predicts travel times, but no agents.")
        durations_s, values, longer = self._drawn(length_m, dependencies, count, rng, resting)
        shift = values[:, 4:] @ self._others(dependencies)
        speeds = np.exp(-values[:, 0] - shift)
        rates = speeds / np.exp(values[:, 1])
        turns = np.full(count, _WIDEST_TURN)
        return durations_s, np.stack([speeds / longer, rates / longer**2, turns], axis=-1)

    def _drawn(
        self,
        length_m: float,
        dependencies: Mapping[str, float],
        count: int,
        rng: np.random.Generator,
        resting: float,
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        turning = dependencies.get(TURNING, 0.0) * length_m
        walk = TimedWalks(
            np.array([length_m]),
            np.array([turning]),
            np.array([resting]),
            self._others(dependencies)[None],
            np.ones(1),
            ("somebody new",),
        )
        return self.posterior.draw(walk, count, rng)

    def _others(self, dependencies: Mapping[str, float]) -> FloatArray:
        if self.scaling is None:
            return np.empty(0)
        return self.scaling.z(self.scaling.vector(dependencies))


def travel_time_model(
    database: WalkDatabase, rng: np.random.Generator, curve: Curve | None = None
) -> TravelTimeModel:
    """Learn a curve, by default ours, from the walks of a database.

    Raises:
        WalkingError: all walks are of one person, or the database is from a file that does not say
            which walks the recording cut off.
    """
    curve = curve or StartingAndStopping()
    walks, scaling = timed_walks_of(database)
    name = MIXED if isinstance(curve, StartingAndStopping) else curve.name
    return TravelTimeModel(name, posterior_of(walks, curve, rng), scaling)


def baseline_models(database: WalkDatabase, rng: np.random.Generator) -> list[TravelTimeModel]:
    """Learn constant speed, a line and a log-log line from the walks of a database."""
    return [travel_time_model(database, rng, curve) for curve in BASELINES]


def each_left_out(database: WalkDatabase) -> list[tuple[str, WalkDatabase]]:
    """Return a database without each of its further dependencies, and P_mixed's name on it.

    A dependency without which predictions are as good is not worth having. Empty if the database
    has only the dependencies of the paper.
    """
    names = further_of(database.names)
    return [(f"{WITHOUT}{name}", database.without([name])) for name in names]


def models_without_each(database: WalkDatabase, rng: np.random.Generator) -> list[TravelTimeModel]:
    """Learn P_mixed without each of the further dependencies, for comparison."""
    return [
        replace(travel_time_model(plain, rng), name=name) for name, plain in each_left_out(database)
    ]


def timed_walks_of(database: WalkDatabase) -> tuple[TimedWalks, Scaling | None]:
    """Return the travel times of a database, and the scaling of its further dependencies."""
    if database.resting is None:
        raise WalkingError(
            "The model was fitted before walks were stored with what the recording cut off: fit it"
            " again to predict by travel times."
        )
    rows = [dict(zip(database.names, row, strict=True)) for row in database.vectors]
    scaling = other_scaling(database)
    others = np.empty((len(database), 0))
    if scaling is not None:
        others = scaling.z(np.stack([scaling.vector(row) for row in rows]))
    return (
        TimedWalks(
            database.lengths_m,
            np.array([turning_of(row | {LENGTH: m}) for row, m in zip(rows, database.lengths_m,
                                                                     strict=True)]),
            database.resting,
            others,
            database.durations_s,
            database.subjects,
        ),
        scaling,
    )  # fmt: skip


def other_scaling(database: WalkDatabase) -> Scaling | None:
    """Return the scaling of the dependencies besides length and turning; None without any."""
    names = tuple(name for name in database.names if name not in (LENGTH, TURNING))
    if not names:
        return None
    return scaling_of(names, database.vectors[:, [database.names.index(name) for name in names]])
