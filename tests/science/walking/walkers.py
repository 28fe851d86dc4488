"""Synthetic walkers for tests: minimum-jerk speed on a rounded path, slower in turns, swaying.

They do not use the planner's follower, and are labelled synthetic.
"""

from collections.abc import Iterator

import numpy as np
from scipy.ndimage import gaussian_filter1d

from app.science.rotations import FloatArray
from app.science.walking.planning.grid_planner import LazyThetaPlanner
from app.science.walking.records.model import PlannedPath, Walk
from app.science.walking.scene.laboratory import (
    POLE_DEG,
    POLE_M,
    STRAIGHT_M,
    pole_scene,
    straight_scene,
)
from app.science.walking.scene.scene import Scene
from app.science.walking.scene.turning import by_length

RATE_HZ, ROUNDED_M, SWAY_M = 120.0, 0.15, 0.015
FASTEST_M_S, NEAR_M = 1.464, 1.879


def walker(
    path: PlannedPath,
    *,
    vigour: float = 1.0,
    stature_m: float = 1.75,
    subject: str = "1",
    sway_m: float = SWAY_M,
) -> Walk:
    """Return a walk along a path from rest to rest, as people walk over short distances.

    Peak speed grows with distance as v = 1.464 (1 - exp(-d / 1.879)) m/s (short walks of Carlisle
    and Kuo), times `vigour`; turning takes extra time.
    """
    line = by_length(path.points_m)
    line = gaussian_filter1d(line, ROUNDED_M / 0.01, axis=0, mode="nearest")
    line[0], line[-1] = path.points_m[0], path.points_m[-1]
    length = path.length_m
    peak = vigour * FASTEST_M_S * (1.0 - np.exp(-length / NEAR_M))
    angles = np.unwrap(np.arctan2(*np.diff(line, axis=0).T[::-1]))
    turned = float(np.abs(np.diff(angles)).sum())
    duration_s = (length + 0.15 * turned) * 1.875 / peak
    times_s = np.arange(round(duration_s * RATE_HZ) + 1) / RATE_HZ
    share = times_s / times_s[-1]
    along = length * (10.0 * share**3 - 15.0 * share**4 + 6.0 * share**5)
    arc = np.linspace(0.0, length, len(line))
    places = np.stack([np.interp(along, arc, line[:, axis]) for axis in (0, 1)], axis=-1)
    places += _sway(times_s, along, places, sway_m)
    return Walk(times_s, places, subject, "made for a test", "synthetic", stature_m)


def _sway(times_s: FloatArray, along: FloatArray, places: FloatArray, sway_m: float) -> FloatArray:
    """Return a lateral sway of one cycle per two steps, which is zero at rest."""
    ahead = np.gradient(places, axis=0)
    ahead /= np.maximum(np.linalg.norm(ahead, axis=1, keepdims=True), 1e-9)
    aside = np.stack([-ahead[:, 1], ahead[:, 0]], axis=-1)
    speed = np.gradient(along, times_s)
    swing = sway_m * np.sin(2.0 * np.pi * 0.9 * times_s) * np.minimum(1.0, 2.0 * speed)
    sway: FloatArray = swing[:, None] * aside
    return sway


def laboratory() -> list[Scene]:
    """Return the sixteen scenes of the paper's first experiment."""
    return [straight_scene(length) for length in STRAIGHT_M] + [
        pole_scene(turn, length) for turn in POLE_DEG for length in POLE_M
    ]


def population(count: int, subjects: int, seed: int = 1) -> Iterator[tuple[LazyThetaPlanner, Walk]]:
    """Return walks of many people over all scenes of the laboratory, with their planned paths.

    Starts and goals differ by some centimetres from walk to walk, as in captures.
    """
    rng = np.random.default_rng(seed)
    planners = [LazyThetaPlanner(scene) for scene in laboratory()]
    people = [(rng.normal(1.0, 0.12), rng.normal(1.78, 0.07)) for _ in range(subjects)]
    for at in range(count):
        planner, (vigour, stature_m) = planners[at % len(planners)], people[at % subjects]
        start, goal = (
            np.array(planner.scene.places[name]) + rng.normal(0.0, 0.02, 2)
            for name in ("start", "goal")
        )
        path = planner.plan((float(start[0]), float(start[1])), (float(goal[0]), float(goal[1])))
        own = vigour * rng.normal(1.0, 0.06)
        yield planner, walker(path, vigour=own, stature_m=stature_m, subject=str(at % subjects))
