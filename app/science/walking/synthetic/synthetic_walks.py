"""Databases of synthetic walks: a population walks through scenes.

Each person walks every path of every scene a given number of times. Start and goal are a few
centimetres from the scene's places, as in people. Tracks are cut and smoothed as captured ones are,
and planned from their own start to their own goal.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.science.walking.planning import LazyThetaPlanner
from app.science.walking.recording import planned_walk, walks_of
from app.science.walking.records import PlannedPath, PlannedWalk, Point, WalkingError
from app.science.walking.scene import (
    POLE_DEG,
    POLE_M,
    STRAIGHT_M,
    Scene,
    SceneError,
    pole_scene,
    straight_scene,
)
from app.science.walking.synthetic.populations import Person, Population, person_of, walk_along

PLACE_SD_M = 0.02
"""Standard deviation, along each axis, of a person's start and end from a place."""


@dataclass(frozen=True)
class Sample:
    """The size of a synthetic sample: how many people of a population walk, and how often.

    Attributes:
        people: number of people.
        repetitions: the number of repetitions of each path by each person.
        seed: a different seed gives different people.
        prefix: put before their names, so that two samples never share a person.
    """

    people: int
    repetitions: int = 1
    seed: int = 1
    prefix: str = ""


def laboratory_scenes() -> list[Scene]:
    """Return the sixteen scenes of the paper's database."""
    return [straight_scene(length) for length in STRAIGHT_M] + [
        pole_scene(turn, distance) for turn in POLE_DEG for distance in POLE_M
    ]


def synthetic_walks(
    population: Population, scenes: Sequence[Scene], sample: Sample
) -> Iterator[PlannedWalk]:
    """Generate walks, person by person; the note of each names its scene and path.

    Raises:
        WalkingError: there are no people, or no paths.
    """
    if sample.people < 1 or sample.repetitions < 1 or not any(scene.paths for scene in scenes):
        raise WalkingError("A population needs people, repetitions and a scene with paths.")
    routes = [
        _Route(LazyThetaPlanner(scene), at) for scene in scenes for at in range(len(scene.paths))
    ]
    for number in range(sample.people):
        rng = np.random.default_rng((sample.seed, number))
        person = person_of(population, number, rng)
        person = replace(person, name=f"{sample.prefix}{person.name}")
        for route in routes:
            for _ in range(sample.repetitions):
                yield from route.walks(person, rng)


@dataclass(frozen=True, eq=False)
class _Route:
    planner: LazyThetaPlanner
    number: int

    def walks(self, person: Person, rng: np.random.Generator) -> Iterator[PlannedWalk]:
        scene = self.planner.scene
        path = scene.paths[self.number]
        start, goal = (self._near(scene.places[name], rng) for name in (path.start, path.goal))
        track = walk_along(person, self.planner.plan(start, goal), rng)
        for walk in walks_of(track):
            annotated = replace(walk, note=f"{scene.name}: {path.name}")
            yield planned_walk(annotated, self.planner)

    def _near(self, place: Point, rng: np.random.Generator) -> Point:
        """Return a random position near a place, at which a person can stand."""
        for _ in range(50):
            x, y = np.array(place) + PLACE_SD_M * rng.standard_normal(2)
            try:
                self.planner.scene.check_point((float(x), float(y)), "A walker")
            except SceneError:
                continue
            return float(x), float(y)
        return place


def straight_path(length_m: float) -> PlannedPath:
    """Return a straight path of a given length, for queries without a scene."""
    if not 0.0 < length_m < np.inf:
        raise WalkingError(f"A path of {length_m} m is invalid: give a positive length.")
    return PlannedPath(np.array([[0.0, 0.0], [0.0, length_m]]))
