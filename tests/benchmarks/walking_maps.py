"""Measure the planner and suitability maps of the walking model, for `./run bench walking`.

`planner`: Lazy Theta* on a lattice of one centimetre, over the walks of the laboratory's sixteen
scenes, and compared with the shortest paths (full visibility graph) on 1,000 random scenes: at most
1 % longer. `maps`: all 1848 maps of 1000 combinations, on all processors, in at most 60 s; the
compiled version is compared with NumPy on some of them, to 1e-9. Compiling is not timed. If other
programs run, the processor time shows what the machine alone would take.
"""

import os
import time
from collections.abc import Iterator

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.maps import MapMaker, maps_of
from app.science.walking.planning import LazyThetaPlanner
from app.science.walking.recording import planned_walk
from app.science.walking.records import PlannedWalk
from app.science.walking.scene import SceneError
from tests.benchmarks.report import Figure
from tests.science.walking.plain_agents import PlainFollower, PlainMetric
from tests.science.walking.random_scenes import random_scene
from tests.science.walking.visibility import VisibilityPlanner
from tests.science.walking.walkers import population

WALKS, SUBJECTS, SCENES, CHECKED = 1848, 30, 1000, 8
PLAN_MS, MAPS_S, EXCESS, AGREEMENT = 14.0, 60.0, 0.01, 1e-9


def planner_figures() -> Iterator[Figure]:
    """Measure how long planning a path takes, and how much the path exceeds the shortest one."""
    walks = list(population(320, SUBJECTS))
    planned_walk(walks[-1][1], walks[-1][0])
    took = []
    for planner, walk in walks:
        began = time.perf_counter()
        planned_walk(walk, planner)
        took.append(1e3 * (time.perf_counter() - began))
    mean = float(np.mean(took))
    yield Figure("planner", "a walk of the laboratory, mean", mean, "ms", "about", PLAN_MS)
    yield Figure("planner", "a walk of the laboratory, p99", float(np.percentile(took, 99)), "ms")
    excess, unlike = _random_scenes()
    yield Figure("planner", f"{SCENES} random scenes, longest excess", 100.0 * float(excess.max()),
                 "%", "at most", 100.0 * EXCESS)  # fmt: skip
    yield Figure("planner", "the same, mean", 100.0 * float(excess.mean()), "%")
    yield Figure("planner", "scenes open to one planner only", float(unlike), "scenes")


def _random_scenes() -> tuple[FloatArray, int]:
    """Return each scene's excess length, and how many scenes only one planner crosses."""
    excess, unlike = [], 0
    for seed in range(SCENES):
        scene, start, goal = random_scene(np.random.default_rng(seed))
        lengths = []
        for planner in (LazyThetaPlanner(scene), VisibilityPlanner(scene)):
            try:
                lengths.append(planner.plan(start, goal).length_m)
            except SceneError:
                lengths.append(np.nan)
        if np.isfinite(lengths).all():
            excess.append(lengths[0] / lengths[1] - 1.0)
        unlike += int(np.isfinite(lengths).sum() == 1)
    return np.array(excess), unlike


def map_figures() -> Iterator[Figure]:
    """Measure how long all maps of a database take, and that both implementations agree."""
    began = time.perf_counter()
    entries = [planned_walk(walk, planner) for planner, walk in population(WALKS, SUBJECTS)]
    yield Figure("maps", f"{WALKS} walks made and planned", time.perf_counter() - began, "s")
    maker = MapMaker()
    maker.map_of(entries[-1])
    began, worked = time.perf_counter(), time.process_time()
    count = sum(1 for _ in maps_of(entries, maker))
    took, worked = time.perf_counter() - began, time.process_time() - worked
    cores = os.cpu_count() or 1
    yield Figure("maps", f"{count} maps on {cores} processors", took, "s", "at most", MAPS_S)
    yield Figure("maps", "the same, processor time a processor", worked / cores, "s")
    yield Figure("maps", "one map, one thread", _one_map_ms(maker, entries), "ms")
    yield Figure("maps", "compiled against NumPy, largest difference", _apart(entries), "",
                 "at most", AGREEMENT)  # fmt: skip


def _one_map_ms(maker: MapMaker, entries: list[PlannedWalk]) -> float:
    took = []
    for entry in entries[:64]:
        began = time.perf_counter()
        maker.map_of(entry)
        took.append(1e3 * (time.perf_counter() - began))
    return float(np.mean(took))


def _apart(entries: list[PlannedWalk]) -> float:
    plain = MapMaker(follower=PlainFollower(), metric=PlainMetric())
    apart = 0.0
    for entry in entries[:: len(entries) // CHECKED]:
        ours, theirs = MapMaker().map_of(entry), plain.map_of(entry)
        if not np.array_equal(ours.arrived, theirs.arrived):
            return float("inf")
        late = np.abs(ours.arrival_s - theirs.arrival_s)[ours.arrived]
        apart = max(apart, float(np.abs(ours.deviations - theirs.deviations).max()))
        apart = max(apart, float(late.max(initial=0.0)))
    return apart
