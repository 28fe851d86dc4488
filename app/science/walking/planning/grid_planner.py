"""The planner: Lazy Theta* on a lattice of one centimetre, with the path then pulled tight.

Nash, Koenig and Tovey (2010), "Lazy Theta*: any-angle path planning and path length analysis in
3D". Lines of sight are checked against the obstacles themselves and not against the lattice, so a
path never cuts a corner; start and goal are at their exact positions and not at the nearest node.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.planning.shortest import passable, shortest_way
from app.science.walking.records import BoolArray, PlannedPath, Point
from app.science.walking.scene import (
    FLAT_M2,
    FREE,
    Lattice,
    Outlines,
    Scene,
    SceneError,
    area_m2,
    contains,
    outlines_of,
)

CELL_M = 0.01
MOST_NODES = 16_000_000
"""A floor of 40 x 40 m; a search then needs about 800 MB of memory."""
SAME_M = 1e-6
NEAR_BEND_M, MOST_PULLS = 0.15, 8
"""Distance within which corners may replace a path's bend, and the number of attempts."""


@dataclass(frozen=True, eq=False)
class _Floor:
    corners: list[FloatArray]
    outlines: Outlines
    scene: Scene
    cell_m: float

    @cached_property
    def lattice(self) -> Lattice:
        """The lattice of nodes, made on first use: if the goal is in sight it is not needed."""
        from app.science.walking.planning.lattice_kernels import block

        left, near, _, _ = self.scene.bounds_m
        shape = _shape(self.scene, self.cell_m)
        lattice = Lattice(
            np.zeros(shape, dtype=np.uint8), np.empty((*shape, 2)), left, near, self.cell_m
        )
        block(lattice, self.outlines)
        return lattice


@dataclass(frozen=True, eq=False)
class LazyThetaPlanner:
    """Plans paths in one scene.

    Attributes:
        scene: the floor and its obstacles.
        cell_m: distance between the lattice's nodes.
    """

    scene: Scene
    cell_m: float = CELL_M

    def __post_init__(self) -> None:
        """Raise SceneError if the cell size is invalid or the lattice would not fit into memory."""
        if not self.cell_m > 0.0:
            raise SceneError(
                f"Lattice cells of {self.cell_m} m are invalid: give a positive size, such as 0.01."
            )
        rows, columns = _shape(self.scene, self.cell_m)
        if rows * columns > MOST_NODES:
            raise SceneError(
                f"A lattice of {self.cell_m} m over scene {self.scene.name!r} has {rows * columns}"
                f" nodes, at most {MOST_NODES} are possible: use larger cells or a smaller floor."
            )

    def plan(self, start_m: Point, goal_m: Point) -> PlannedPath:
        """Plan a path from a start to a goal.

        Raises:
            SceneError: start or goal is out of bounds or inside an obstacle, both are at the same
                position, or obstacles leave no path between them.
        """
        from app.science.walking.planning import planner_kernels as kernels

        check_ends(self.scene, start_m, goal_m)
        floor = self._floor_of(start_m, goal_m)
        ends = np.array([start_m, goal_m], dtype=np.float64)
        if kernels.sees(*start_m, *goal_m, floor.outlines):
            return PlannedPath(ends)
        start, goal = self._node(start_m), self._node(goal_m)
        lattice = _with_ends(floor.lattice, start, goal, ends)
        nodes = kernels.lazy_theta(lattice, start, goal, floor.outlines)
        if start == goal or not len(nodes):
            raise no_path_error(self.scene, start_m, goal_m)
        points = lattice.places.reshape(-1, 2)[nodes]
        return PlannedPath(_pull_tight(points, floor))

    def _node(self, point_m: Point) -> int:
        left, near, _, _ = self.scene.bounds_m
        rows, columns = _shape(self.scene, self.cell_m)
        row = min(rows - 1, round((point_m[1] - near) / self.cell_m))
        return row * columns + min(columns - 1, round((point_m[0] - left) / self.cell_m))

    def _floor_of(self, start_m: Point, goal_m: Point) -> _Floor:
        if self.scene.is_near_obstacle(start_m) or self.scene.is_near_obstacle(goal_m):
            return self._make_floor(start_m, goal_m)
        return self._usual_floor

    @cached_property
    def _usual_floor(self) -> _Floor:
        return self._make_floor()

    def _make_floor(self, *standing_m: Point) -> _Floor:
        corners = self.scene.widened_obstacles(*standing_m)
        return _Floor(corners, outlines_of(corners), self.scene, self.cell_m)


def _shape(scene: Scene, cell_m: float) -> tuple[int, int]:
    """Return the numbers of rows and columns of a scene's lattice."""
    left, near, right, far = scene.bounds_m
    # Tolerate rounding at the bounds: 4 m are 400 cells, not 399.999.
    rows = math.floor((far - near) / cell_m + SAME_M) + 1
    return rows, math.floor((right - left) / cell_m + SAME_M) + 1


def _with_ends(lattice: Lattice, start: int, goal: int, ends: FloatArray) -> Lattice:
    """Return a copy in which the nodes of start and goal are free and at the exact positions."""
    state, places = lattice.state.copy(), lattice.places.copy()
    flat = places.reshape(-1, 2)
    state.reshape(-1)[[start, goal]] = FREE
    flat[start], flat[goal] = ends
    return lattice._replace(state=state, places=places)


def check_ends(scene: Scene, start_m: Point, goal_m: Point) -> None:
    """Raise SceneError if a person cannot stand at start or goal, or if both are the same."""
    scene.check_point(start_m, "The start")
    scene.check_point(goal_m, "The goal")
    if math.dist(start_m, goal_m) < SAME_M:
        raise SceneError(f"Start and goal are the same place, ({start_m[0]:g}, {start_m[1]:g}) m.")


def no_path_error(scene: Scene, start_m: Point, goal_m: Point) -> SceneError:
    """Return the error for a scene in which obstacles block every path between two points."""
    return SceneError(
        f"In scene {scene.name!r} there is no way from ({start_m[0]:.2f}, {start_m[1]:.2f}) to"
        f" ({goal_m[0]:.2f}, {goal_m[1]:.2f}) m: obstacles, widened by {scene.clearance_m:g} m,"
        " block it. Open a gap, or lower the scene's clearance."
    )


def _pull_tight(points_m: FloatArray, floor: _Floor) -> FloatArray:
    """Shorten a path around the corners that it passes, like a string that is pulled tight.

    A path on a lattice bends next to the corner that it passes, or short of it in the open. The
    shortest path that leaves the obstacles on the same sides bends at corners inside the triangles
    of neighbouring points; this is repeated until nothing changes.
    """
    corners = passable(floor.corners, floor.corners, floor.scene.bounds_m)
    for _ in range(MOST_PULLS):
        near_bends = _near_bends(corners, points_m)
        places = np.concatenate([points_m[:1], points_m[-1:], points_m[1:-1], corners[near_bends]])
        way = shortest_way(places, floor.outlines)
        if way is None or np.array_equal(way, points_m):
            break
        points_m = way
    return points_m


def _near_bends(corners: FloatArray, points_m: FloatArray) -> BoolArray:
    """Return which corners are close to a bend, or in the triangle of it and its neighbours."""
    found = np.zeros(len(corners), dtype=np.bool_)
    for before, bend, after in zip(points_m[:-2], points_m[1:-1], points_m[2:], strict=True):
        triangle = np.array([before, bend, after])
        if area_m2(triangle) < 0.0:
            triangle = triangle[::-1]
        if area_m2(triangle) > FLAT_M2:
            found |= contains(triangle, corners, margin_m=-SAME_M)
        found |= np.linalg.norm(corners - bend, axis=1) < NEAR_BEND_M
    return found
