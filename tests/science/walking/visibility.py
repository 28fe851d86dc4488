"""The reference planner: the shortest path by the full visibility graph.

Among convex outlines the shortest path bends only at their corners, and the graph over all corners
contains it exactly. It is slow with many corners, and is used to check the fast planner.
"""

from dataclasses import dataclass

import numpy as np

from app.science.walking.planning.grid_planner import check_ends, no_path_error
from app.science.walking.planning.shortest import passable, shortest_way
from app.science.walking.records.model import PlannedPath
from app.science.walking.records.protocols import Point
from app.science.walking.scene.outlines import outlines_of
from app.science.walking.scene.scene import Scene


@dataclass(frozen=True, eq=False)
class VisibilityPlanner:
    """A `Planner` that finds the exact shortest paths in one scene."""

    scene: Scene

    def plan(self, start_m: Point, goal_m: Point) -> PlannedPath:
        """Return the shortest path; raises SceneError as `LazyThetaPlanner.plan` does."""
        check_ends(self.scene, start_m, goal_m)
        corners = self.scene.widened_obstacles(start_m, goal_m)
        ends = np.array([start_m, goal_m], dtype=np.float64)
        places = np.concatenate([ends, passable(corners, corners, self.scene.bounds_m)])
        way = shortest_way(places, outlines_of(corners))
        if way is None:
            raise no_path_error(self.scene, start_m, goal_m)
        return PlannedPath(way)
