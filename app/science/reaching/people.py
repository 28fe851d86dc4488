"""How people differ in their tempo, kept apart from how one person's reaches differ.

Reaches of one person are not independent: a hundred reaches of two people are two people. So each
person has a level, the mean logarithm of their tempos; the maps of their reaches are taken relative
to it, and describe what is left: how single reaches of one person differ, and how pace depends on
distance. People reach over different distances, so levels are compared at the same distance, by a
slope that is estimated within people.

The level of somebody new follows Student's t around the mean of the levels. Their SD is hardly
known from few people: the SD that the simulation assumes counts as `ASSUMED_PEOPLE` degrees of
freedom. With a single person it is all there is.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.science.reaching.agent import PERSON_GRID
from app.science.rotations import FloatArray
from app.science.simulation import TEMPO_SPREAD
from app.science.walking.maps import MAP_FLOATS, MapArray, WalkDatabase

ASSUMED_PEOPLE = 3.0
"""Degrees of freedom of the assumed SD between people."""
FARTHEST = 1.0
"""Largest deviation of a drawn level from the mean: a factor of 2.7."""


@dataclass(frozen=True, eq=False)
class Levels:
    """The levels of n people: means of logarithms of tempos.

    Attributes:
        names: the people, sorted.
        logs: (n,) their levels.
        counts: (n,) the number of reaches of each.
        slope: by how much the logarithm of tempo rises with that of distance, within people.
    """

    names: tuple[str, ...]
    logs: FloatArray
    counts: tuple[int, ...]
    slope: float

    @property
    def mean(self) -> float:
        """The mean level; each person counts once."""
        return float(self.logs.mean())

    @property
    def spread(self) -> float:
        """The SD between people, to which the assumed one contributes."""
        deviations = float(((self.logs - self.mean) ** 2).sum())
        total = ASSUMED_PEOPLE * TEMPO_SPREAD**2 + deviations
        return float(np.sqrt(total / self.freedom))

    @property
    def freedom(self) -> float:
        """Degrees of freedom of the spread."""
        return ASSUMED_PEOPLE + len(self.names) - 1.0

    def interval(self) -> tuple[float, float]:
        """Return the ends of the 95 % interval of the median person's tempo."""
        from scipy import stats

        half = float(stats.t.ppf(0.975, self.freedom)) * self.spread / np.sqrt(len(self.names))
        return float(np.exp(self.mean - half)), float(np.exp(self.mean + half))

    def draw(self, count: int, rng: np.random.Generator) -> FloatArray:
        """Draw the levels of new people, (count,)."""
        scale = self.spread * np.sqrt(1.0 + 1.0 / len(self.names))
        away = scale * rng.standard_t(self.freedom, count)
        return np.asarray(self.mean + np.clip(away, -FARTHEST, FARTHEST), dtype=np.float64)


def levels_of(log_tempos: FloatArray, distances_m: FloatArray, subjects: Sequence[str]) -> Levels:
    """Return people's levels.

    Args:
        log_tempos: (N,) logarithms of the tempos of single reaches.
        distances_m: (N,) their distances.
        subjects: whose each is.
    """
    names, person = np.unique(np.array(subjects), return_inverse=True)
    counts = np.bincount(person)

    def means(values: FloatArray) -> FloatArray:
        return np.asarray(np.bincount(person, weights=values) / counts, dtype=np.float64)

    far = np.log(distances_m)
    own = far - means(far)[person]
    variation = float(own @ own)
    slope = float(own @ (log_tempos - means(log_tempos)[person])) / variation if variation else 0.0
    # At the mean distance of all reaches.
    logs = means(log_tempos - slope * (far - far.mean()))
    return Levels(tuple(names.tolist()), logs, tuple(counts.tolist()), slope)


def relative_to_people(database: WalkDatabase, levels: Levels) -> WalkDatabase:
    """Return the database with maps over tempos relative to each person's level.

    Deviations and arrivals are interpolated along the logarithm of tempo. Beyond the maps' tempos
    the outermost deviation holds, and arrivals are proportional to tempo.
    """
    level_of = dict(zip(levels.names, levels.logs.tolist(), strict=True))
    logs = np.array(database.grid.values[0])
    wanted = np.array(PERSON_GRID.values[0])
    shape = (len(database), len(logs), database.grid.shape[1])
    deviations = np.empty((len(database), PERSON_GRID.size), dtype=MAP_FLOATS)
    arrivals_s = np.empty_like(deviations)
    for at, subject in enumerate(database.subjects):
        shifted = wanted + level_of[subject]
        deviations[at] = _along(database.deviations.reshape(shape)[at], logs, shifted).ravel()
        # Over its tempo the arrival hardly changes, so what is interpolated is nearly constant.
        per_tempo = database.arrivals_s.reshape(shape)[at] / np.exp(logs)[:, None]
        own = _along(per_tempo, logs, shifted) * np.exp(shifted)[:, None]
        arrivals_s[at] = own.ravel()
    return WalkDatabase(
        PERSON_GRID,
        database.metric,
        database.names,
        database.vectors,
        deviations,
        arrivals_s,
        database.durations_s,
        database.lengths_m,
        database.subjects,
        database.sources,
        database.kinds,
    )


def _along(table: MapArray | FloatArray, at: FloatArray, wanted: FloatArray) -> FloatArray:
    columns = [np.interp(wanted, at, column) for column in table.T.astype(np.float64)]
    return np.stack(columns, axis=-1)
