"""The database of walks with their dependencies and maps, as plain tables.

It contains everything from which a model is fitted, and all that is stored of the walks: no
trajectories. Maps are stored as deviations and travel times, so that they can be converted to
suitability again, with other options or for part of the walks.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray
from app.science.walking.maps.densifying import MAP_FLOATS, IntArray, MapArray
from app.science.walking.maps.suitability import DeviationMap, SuitabilityOptions
from app.science.walking.records import ParameterGrid, PlannedWalk, WalkingError, dependency_vectors

PERSONS = 2
"""Fewest people from which differences between people can be learnt and validated."""


@dataclass(frozen=True, eq=False)
class WalkDatabase:
    """Dependencies and maps of N walks.

    Attributes:
        grid: combinations of steering parameters, K of them.
        metric: measure of deviation.
        names: the names of the m dependencies.
        vectors: (N, m) values of the dependencies.
        deviations: (N, K) deviations of all combinations.
        arrivals_s: (N, K) travel times, NaN where an agent did not arrive.
        durations_s: (N,) travel times of the walks themselves.
        lengths_m: (N,) lengths of the planned paths.
        subjects, sources, kinds: the subject, source and kind of each walk.
        resting: (N,) 1 for a walk from rest to rest, .5 if the recording cuts one of its ends, 0 if
            it cuts both; None for a database from a file that does not say.
    """

    grid: ParameterGrid
    metric: str
    names: tuple[str, ...]
    vectors: FloatArray
    deviations: MapArray
    arrivals_s: MapArray
    durations_s: FloatArray
    lengths_m: FloatArray
    subjects: tuple[str, ...]
    sources: tuple[str, ...]
    kinds: tuple[str, ...]
    resting: FloatArray | None = None

    def __post_init__(self) -> None:
        """Raise WalkingError if the shapes of the tables do not match."""
        count, shape = len(self.subjects), (len(self.subjects), self.grid.size)
        fits = (
            count > 0
            and self.vectors.shape == (count, len(self.names))
            and self.deviations.shape == shape == self.arrivals_s.shape
            and self.durations_s.shape == (count,) == self.lengths_m.shape
            and len(self.sources) == count == len(self.kinds)
            and (self.resting is None or self.resting.shape == (count,))
        )
        if not fits:
            raise WalkingError("The shapes of the tables of a database of walks do not match.")

    def __len__(self) -> int:
        """Return the number of walks, N."""
        return len(self.subjects)

    @property
    def persons(self) -> tuple[str, ...]:
        """The names of all people who walked, sorted."""
        return tuple(sorted(set(self.subjects)))

    def select(self, chosen: IntArray | npt.NDArray[np.bool_]) -> "WalkDatabase":
        """Return part of the walks, chosen by indices or a mask."""
        at = np.arange(len(self))[chosen]
        return WalkDatabase(
            self.grid,
            self.metric,
            self.names,
            self.vectors[at],
            self.deviations[at],
            self.arrivals_s[at],
            self.durations_s[at],
            self.lengths_m[at],
            tuple(self.subjects[i] for i in at),
            tuple(self.sources[i] for i in at),
            tuple(self.kinds[i] for i in at),
            None if self.resting is None else self.resting[at],
        )

    def without(self, names: Iterable[str]) -> "WalkDatabase":
        """Return the same walks without some of the dependencies."""
        left_out = set(names)
        kept = [at for at, name in enumerate(self.names) if name not in left_out]
        return replace(
            self, names=tuple(self.names[at] for at in kept), vectors=self.vectors[:, kept]
        )

    def walked_by(self, persons: Iterable[str]) -> npt.NDArray[np.bool_]:
        """Return which walks are of one of these people, (N,)."""
        chosen_subjects = set(persons)
        return np.array([subject in chosen_subjects for subject in self.subjects])

    def suitability(self, options: SuitabilityOptions) -> MapArray:
        """Convert all maps to suitability, (N, K)."""
        values = np.empty((len(self), self.grid.size), dtype=MAP_FLOATS)
        for at in range(len(self)):
            values[at] = self.map_at(at).read(options).values.ravel()
        return values

    def map_at(self, at: int) -> DeviationMap:
        """Return the deviation map of one walk."""
        shape = self.grid.shape
        return DeviationMap(
            self.grid,
            self.metric,
            self.deviations[at].astype(np.float64).reshape(shape),
            self.arrivals_s[at].astype(np.float64).reshape(shape),
            float(self.durations_s[at]),
        )


def database_of(
    entries: Sequence[PlannedWalk], maps: Sequence[DeviationMap], names: Sequence[str]
) -> WalkDatabase:
    """Build a database from planned walks and their maps.

    Raises:
        WalkingError: there is no walk, a walk lacks one of the dependencies, or grids or metrics of
            the maps differ.
    """
    if not entries or len(entries) != len(maps):
        raise WalkingError(
            f"{len(entries)} walks with {len(maps)} maps are not a database: give each walk a map."
        )
    grid, metric = maps[0].grid, maps[0].metric
    if any(one.grid != grid or one.metric != metric for one in maps):
        raise WalkingError("Maps of different grids or metrics cannot be combined.")
    walks = [entry.walk for entry in entries]
    sources = [walk.source for walk in walks]
    return WalkDatabase(
        grid,
        metric,
        tuple(names),
        dependency_vectors(names, [entry.dependencies for entry in entries], sources),
        np.stack([one.deviations.ravel() for one in maps]).astype(MAP_FLOATS),
        np.stack([one.arrival_s.ravel() for one in maps]).astype(MAP_FLOATS),
        np.array([walk.duration_s for walk in walks]),
        np.array([entry.path.length_m for entry in entries]),
        tuple(walk.subject for walk in walks),
        tuple(sources),
        tuple(walk.kind for walk in walks),
        np.array([(walk.begins_still + walk.ends_still) / 2.0 for walk in walks]),
    )


def check_persons(database: WalkDatabase) -> None:
    """Raise WalkingError if the walks are of too few people."""
    if len(database.persons) < PERSONS:
        raise WalkingError(
            f"All {len(database)} walks are of one subject, {database.persons[0]!r}. How people"
            f" differ cannot be learnt from one: give walks of {PERSONS} or more, and name who"
            " walks in each."
        )
