"""Tests that the planner finds short collision-free paths deterministically."""

import math

import numpy as np
import pytest

from app.adapters.walks.scene_file import load_shipped, shipped_scenes
from app.science.walking.planning.grid_planner import LazyThetaPlanner
from app.science.walking.planning.shortest import sees
from app.science.walking.recording.walks import dependencies_of
from app.science.walking.records.model import PlannedPath
from app.science.walking.scene.laboratory import POLE_DEG, pole_scene, straight_scene
from app.science.walking.scene.outlines import outlines_of
from app.science.walking.scene.scene import Scene, SceneError, box, open_scene
from tests.science.walking.random_scenes import random_scene
from tests.science.walking.visibility import VisibilityPlanner

FLOOR = (-2.0, -2.0, 2.0, 2.0)


def _is_free(path: PlannedPath, scene: Scene) -> bool:
    ends = [(float(x), float(y)) for x, y in path.points_m[[0, -1]]]
    outlines = outlines_of(scene.widened_obstacles(*ends))
    legs = zip(path.points_m[:-1], path.points_m[1:], strict=True)
    return all(sees(a[0], a[1], b[0], b[1], outlines) for a, b in legs)


def _excess(seed: int) -> float:
    """Return the excess over the shortest path as a share; 0 if both planners find none."""
    scene, start, goal = random_scene(np.random.default_rng(seed))
    try:
        shortest = VisibilityPlanner(scene).plan(start, goal)
    except SceneError:
        with pytest.raises(SceneError, match="no way"):
            LazyThetaPlanner(scene).plan(start, goal)
        return 0.0
    path = LazyThetaPlanner(scene).plan(start, goal)
    assert _is_free(path, scene)
    assert path.points_m[0] == pytest.approx(start)
    assert path.points_m[-1] == pytest.approx(goal)
    return path.length_m / shortest.length_m - 1.0


def test_paths_are_at_most_one_percent_longer_than_the_shortest() -> None:
    """On sixty random scenes paths are at most 1 % longer than the visibility graph's optimum."""
    excess = np.array([_excess(seed) for seed in range(60)])
    assert excess.max() <= 0.01
    assert excess.min() >= -1e-9


@pytest.mark.long
def test_paths_are_at_most_one_percent_longer_on_a_thousand_scenes() -> None:
    """On a thousand random scenes paths are at most 1 % longer than the optimum."""
    assert max(_excess(seed) for seed in range(1000)) <= 0.01


def test_the_shortest_way_round_a_box_is_known() -> None:
    """Round a corner of a box without clearance the path has two straight legs."""
    scene = Scene("box", FLOOR, (box("box", (0.0, 0.0), (1.0, 1.0)),), clearance_m=0.0)
    expected = math.dist((-1.5, 0.2), (-0.5, 0.5)) + 1.0 + math.dist((0.5, 0.5), (1.5, 0.2))
    for planner in (LazyThetaPlanner(scene), VisibilityPlanner(scene)):
        path = planner.plan((-1.5, 0.2), (1.5, 0.2))
        assert path.length_m == pytest.approx(expected, abs=1e-6)


def test_a_free_line_of_sight_is_the_path() -> None:
    """With a free line of sight the path is that line, with exact ends off the lattice."""
    start, goal = (0.1234567, -0.7654321), (1.0101010, 3.0303030)
    path = LazyThetaPlanner(open_scene(start, goal)).plan(start, goal)
    assert path.points_m.tolist() == [list(start), list(goal)]


def test_planning_again_gives_the_same() -> None:
    """Planning again gives the same path, by any planner object and after other paths."""
    scene, start, goal = random_scene(np.random.default_rng(5))
    planner = LazyThetaPlanner(scene)
    first = planner.plan(start, goal)
    planner.plan(goal, start)
    for other in (planner, LazyThetaPlanner(scene)):
        assert other.plan(start, goal).points_m.tobytes() == first.points_m.tobytes()


def test_a_gap_narrower_than_a_cell_is_walked_through() -> None:
    """A gap of four millimetres off the lattice is found."""
    walls = (
        box("left", (-1.0015, 0.0), (1.996, 0.1)),
        box("right", (1.0015, 0.0), (1.992, 0.1)),
    )
    scene = Scene("gap", FLOOR, walls, clearance_m=0.0)
    path = LazyThetaPlanner(scene).plan((0.5, -1.0), (0.5, 1.0))
    shortest = VisibilityPlanner(scene).plan((0.5, -1.0), (0.5, 1.0))
    assert path.length_m == pytest.approx(shortest.length_m, rel=0.01)


def test_a_closed_scene_has_no_path() -> None:
    """No path is found if a wall or a gap narrower than the clearance separates start and goal."""
    wall = box("wall", (0.0, 0.0), (5.0, 0.1))
    narrow = (box("left", (-1.1, 0.0), (1.9, 0.1)), box("right", (1.1, 0.0), (1.9, 0.1)))
    for obstacles in ((wall,), narrow):
        scene = Scene("shut", FLOOR, obstacles)
        for planner in (LazyThetaPlanner(scene), VisibilityPlanner(scene)):
            with pytest.raises(SceneError, match=r"'shut' there is no way.*clearance"):
                planner.plan((0.0, -1.0), (0.0, 1.0))


@pytest.mark.parametrize(
    ("goal", "expected_message"),
    [
        ((0.0, 0.0), "The goal is at .* inside obstacle 'box'"),
        ((0.0, 5.0), "The goal is at .* outside"),
        ((float("nan"), 0.0), "The goal is at .* finite"),
        ((-1.0, -1.0), "same place"),
    ],
)
def test_an_invalid_goal_is_rejected(goal: tuple[float, float], expected_message: str) -> None:
    """A goal that is in an obstacle, out of bounds, not finite or the start is rejected."""
    scene = Scene("box", FLOOR, (box("box", (0.0, 0.0), (1.0, 1.0)),))
    with pytest.raises(SceneError, match=expected_message):
        LazyThetaPlanner(scene).plan((-1.0, -1.0), goal)


def test_a_lattice_too_large_is_rejected() -> None:
    """A lattice that would not fit into memory, a kilometre in millimetres, is rejected."""
    with pytest.raises(SceneError, match="at most"):
        LazyThetaPlanner(Scene("vast", (0.0, 0.0, 900.0, 900.0)), cell_m=0.001)


def test_turning_grows_with_the_angle_round_the_pole() -> None:
    """Turning per metre is 0 on a line and grows with the angle walked round the pole."""
    line = straight_scene(3.0)
    turnings = [_turning(line, "start", "goal")]
    turnings += [_turning(pole_scene(turn, 3.0), "start", "goal") for turn in POLE_DEG]
    assert turnings[0] == pytest.approx(0.0, abs=1e-9)
    assert (np.diff(turnings) > 0.1).all()


def _turning(scene: Scene, start: str, goal: str) -> float:
    path = LazyThetaPlanner(scene).plan(scene.places[start], scene.places[goal])
    return dependencies_of(path)["turning_per_m"]


@pytest.mark.parametrize("key", ["car-and-three-racks", "car-between-two-racks"])
def test_the_papers_workplaces_have_its_distances(key: str) -> None:
    """Both workplaces have the paper's 11 and 6 paths and, to 1 %, its distances to the racks."""
    scene = load_shipped(key)
    expected = {
        "car-and-three-racks": (11, {"rack-3": 0.7, "rack-1": 2.2, "rack-2": 2.9}),
        "car-between-two-racks": (6, {"rack-1": 2.0, "rack-2": 2.4}),
    }[key]
    assert len(scene.paths) == expected[0]
    assert set(shipped_scenes()) == {"car-and-three-racks", "car-between-two-racks"}
    planner = LazyThetaPlanner(scene)
    for path in scene.paths:
        length = planner.plan(scene.places[path.start], scene.places[path.goal]).length_m
        ends = {path.start, path.goal} - {"assembly"}
        walked = sum(expected[1][end] for end in ends)
        assert length == pytest.approx(walked, rel=0.01)
