"""Tests of suitability maps: recovered parameters, formulas of readings, resumed runs."""

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest

from app.science.walking.following.following import SteeringFollower
from app.science.walking.following.metrics import EuclideanMetric, PaceMetric
from app.science.walking.maps.maps import MapMaker, maps_of
from app.science.walking.maps.suitability import PAPER, TIME_AWARE, DeviationMap, SuitabilityOptions
from app.science.walking.planning.grid_planner import LazyThetaPlanner
from app.science.walking.recording.walks import planned_walk
from app.science.walking.records.model import PlannedWalk, Walk, WalkingError
from app.science.walking.records.parameters import (
    PAPER_PARAMETERS,
    ParameterGrid,
    SteeringParameter,
    regular_grid,
)
from app.science.walking.records.protocols import Course, Metric, Trajectories, reference_of
from app.science.walking.scene.laboratory import pole_scene, straight_scene
from app.science.walking.scene.scene import Scene
from tests.science.walking.plain_agents import PlainFollower, PlainMetric
from tests.science.walking.walkers import walker

GRID = regular_grid(PAPER_PARAMETERS, 4)
MAKER = MapMaker(GRID)
LINE, POLE = straight_scene(3.0), pole_scene(90.0, 3.0)


def _entry(scene: Scene, vigour: float = 1.0) -> PlannedWalk:
    planner = LazyThetaPlanner(scene)
    path = planner.plan(scene.places["start"], scene.places["goal"])
    return planned_walk(walker(path, vigour=vigour), planner)


def _walked_by(vector: np.ndarray[tuple[int], np.dtype[np.float64]]) -> PlannedWalk:
    """Return a walk round the pole that the follower itself made."""
    path = LazyThetaPlanner(POLE).plan(POLE.places["start"], POLE.places["goal"])
    follower = SteeringFollower()
    result = follower.follow(Course(path, 2000, 33.0), vector[None])
    count = int(result.arrival_s[0] / follower.dt_s) + 2
    times_s = np.arange(count, dtype=np.float64) * follower.dt_s
    walk = Walk(times_s, result.xy_m[0, :count], "1", "follower")
    return PlannedWalk(walk, path)


@pytest.mark.parametrize("index", [22, 42, 63])
@pytest.mark.parametrize("metric", [EuclideanMetric(), PaceMetric()])
def test_known_parameters_are_recovered(index: int, metric: Metric) -> None:
    """A walk made with a combination of the grid has its smallest deviation, zero, at that one.

    Both metrics are tested through the same protocol.
    """
    made = MapMaker(GRID, metric=metric).map_of(_walked_by(GRID.node(index)))
    assert made.metric == metric.name
    assert made.deviations.ravel()[index] == pytest.approx(0.0, abs=1e-9)
    assert made.read(PAPER).best == pytest.approx(GRID.node(index))
    assert made.read(TIME_AWARE).best == pytest.approx(GRID.node(index))


def test_the_metric_is_equation_five() -> None:
    """The metric is equation 5: the summed distances of the samples over the reference's length."""
    entry = _entry(POLE)
    reference = reference_of(entry.walk, 1.0 / 60.0)
    places = reference.xy_m[None] + np.array([0.03, 0.04])
    expected = 0.05 * len(reference.xy_m) / entry.walk.length_m
    for backend in (EuclideanMetric(), PlainMetric()):
        found = backend.deviations(reference, Trajectories(places, np.array([1.0])))
        assert found == pytest.approx([expected])


def test_compiled_and_plain_maps_agree() -> None:
    """Compiled and plain deviations and travel times agree to 1e-9, straight and round the pole."""
    plain = MapMaker(GRID, PlainFollower(), PlainMetric())
    for scene in (LINE, POLE):
        entry = _entry(scene)
        ours, theirs = MAKER.map_of(entry), plain.map_of(entry)
        assert np.abs(ours.deviations - theirs.deviations).max() <= 1e-9
        assert np.array_equal(ours.arrived, theirs.arrived)
        late = np.abs(ours.arrival_s - theirs.arrival_s)[ours.arrived]
        assert late.max() <= 1e-9


def test_readings_are_the_formulas() -> None:
    """Each reading of a map follows its formula: 1 - m / max, min-max, time-aware, threshold."""
    one = ParameterGrid((SteeringParameter("p", "", 0.0, 3.0),), ((0.0, 1.0, 2.0, 3.0),))
    arrival = np.array([2.0, 2.1, 3.0, np.nan])
    made = DeviationMap(one, "euclidean", np.array([1.0, 2.0, 4.0, 1.0]), arrival, 2.0)
    assert made.read(PAPER).values == pytest.approx([0.75, 0.5, 0.0, 0.75])
    assert made.read(SuitabilityOptions("min-max")).values == pytest.approx([1, 2 / 3, 0, 1])
    timed = made.read(TIME_AWARE)
    assert timed.values == pytest.approx([0.75, 0.5 * np.exp(-1.0), 0.0, 0.0])
    assert timed.arrived.tolist() == [True, True, True, False]
    squared = made.read(SuitabilityOptions(power=2.0, threshold=0.3))
    assert squared.values == pytest.approx([0.5625, 0.0, 0.0, 0.5625])


def test_in_a_flat_map_the_last_combination_wins() -> None:
    """A flat map is suitable everywhere by min-max, and its best is the last combination."""
    one = ParameterGrid((SteeringParameter("p", "", 0.0, 3.0),), ((0.0, 1.0, 3.0),))
    made = DeviationMap(one, "euclidean", np.ones(3), np.full(3, np.nan), 2.0)
    assert made.read(SuitabilityOptions("min-max")).values.tolist() == [1.0, 1.0, 1.0]
    assert made.read(PAPER).best.tolist() == [3.0]


def test_on_a_straight_walk_the_largest_omega_wins_the_tie() -> None:
    """On a straight walk all omegas deviate equally, and the largest is the best."""
    made = MAKER.map_of(_entry(LINE))
    assert (made.deviations == made.deviations[:, :, :1]).all()
    assert made.read(TIME_AWARE).best[2] == pytest.approx(2.0)


@pytest.mark.parametrize(
    "options",
    [
        partial(SuitabilityOptions, power=0.0),
        partial(SuitabilityOptions, power=np.inf),
        partial(SuitabilityOptions, threshold=1.0),
        partial(SuitabilityOptions, threshold=-0.1),
        partial(SuitabilityOptions, time_constant_s=0.0),
    ],
)
def test_invalid_readings_are_rejected(options: Callable[[], SuitabilityOptions]) -> None:
    """Power, threshold and time constant out of range are rejected."""
    with pytest.raises(WalkingError):
        options()


def test_maps_are_the_same_in_threads_after_a_stop_and_a_resume() -> None:
    """A run of five maps that was stopped after two and resumed gives the same maps in order."""
    entries = [_entry(LINE, vigour) for vigour in (0.8, 0.9, 1.0, 1.1, 1.2)]
    whole = dict(maps_of(entries, MAKER, threads=2))
    reported: list[tuple[int, int]] = []

    def progress(done: int, of: int) -> None:
        reported.append((done, of))

    def stop() -> bool:
        return len(reported) == 2

    made_maps = dict(maps_of(entries, MAKER, threads=1, stop=stop, progress=progress))
    assert list(made_maps) == [0, 1]
    made_maps |= dict(maps_of(entries, MAKER, done=made_maps, progress=progress))
    assert reported == [(done, 5) for done in range(1, 6)]
    assert list(made_maps) == [0, 1, 2, 3, 4]
    for index, made in made_maps.items():
        assert made.deviations.tobytes() == whole[index].deviations.tobytes()
        assert made.arrival_s.tobytes() == whole[index].arrival_s.tobytes()


def test_an_entry_that_fails_ends_the_run_with_its_error() -> None:
    """An invalid entry raises its error after the maps before it were returned."""
    good = _entry(LINE)
    walk = Walk(np.array([0.0, 1.0]), np.zeros((2, 2)), "1", "stands")
    run = maps_of([good, PlannedWalk(walk, good.path)], MAKER, threads=1)
    assert next(run)[0] == 0
    with pytest.raises(WalkingError, match="does not move"):
        next(run)


def test_a_grid_over_other_parameters_is_rejected() -> None:
    """A grid of other parameters raises an error that names the follower's and its own names."""
    other = regular_grid((SteeringParameter("sway", "m", 0.0, 1.0),), 3)
    with pytest.raises(WalkingError, match="sway"):
        MapMaker(other)


def test_a_follower_of_other_parameters_is_supported() -> None:
    """A follower with one parameter of its own works with planner, metrics and maps."""

    class Sliding:
        """A follower that moves at constant speed along the line between the path's ends."""

        parameters = (SteeringParameter("pace", "m/s", 0.2, 2.0),)
        dt_s = 0.02

        def follow(
            self, course: Course, vectors: np.ndarray[tuple[int, ...], np.dtype[np.float64]]
        ) -> Trajectories:
            """Move along the line."""
            ends = course.path.points_m
            share = vectors * np.arange(course.samples) * self.dt_s / course.path.length_m
            share = np.minimum(share, 1.0)[..., None]
            arrival = course.path.length_m / vectors[:, 0]
            return Trajectories(ends[0] + share * (ends[-1] - ends[0]), arrival)

    follower = Sliding()
    grid = regular_grid(follower.parameters, 19)
    entry = _entry(LINE)
    for metric in (EuclideanMetric(), PaceMetric()):
        made = MapMaker(grid, follower, metric).map_of(entry)
        mean_m_s = entry.walk.length_m / entry.walk.duration_s
        assert made.read(TIME_AWARE).best[0] == pytest.approx(mean_m_s, abs=0.11)
