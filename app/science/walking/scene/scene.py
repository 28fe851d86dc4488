"""A scene: the floor on which people walk, its obstacles, and the places between which they walk.

An agent is a point, its centre of mass, so obstacles are widened by a `clearance_m`, about half a
body's width. People do stand closer than that to a rack into which they reach. If a path's start or
goal is closer to an obstacle, that obstacle is widened only by this distance, for that path; a
start or goal inside an obstacle is rejected.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records import Point, WalkingError
from app.science.walking.scene.shapes import (
    FLAT_M2,
    area_m2,
    box_corners,
    contains,
    distance_m,
    is_convex,
    widened,
)

CLEARANCE_M = 0.2
"""Default clearance of a scene. The paper does not state one."""
NEAR_M = 1e-6
"""Smallest distance kept from an obstacle that a start or goal touches."""


class SceneError(WalkingError):
    """A scene, or a path in it, is impossible: a goal in an obstacle, no path, a bad outline."""


@dataclass(frozen=True, eq=False)
class Obstacle:
    """An obstacle with convex corners (K, 2), counter-clockwise."""

    name: str
    corners_m: FloatArray

    def __post_init__(self) -> None:
        """Raise SceneError if the outline is not convex or has no area."""
        corners = self.corners_m
        if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3:
            raise SceneError(f"Obstacle {self.name!r} needs three corners or more.")
        if not np.isfinite(corners).all():
            raise SceneError(f"Obstacle {self.name!r} has corners that are not finite numbers.")
        edges = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1)
        if edges.min() < NEAR_M:
            raise SceneError(f"Obstacle {self.name!r} has the same corner twice in a row.")
        if abs(area_m2(corners)) < FLAT_M2:
            raise SceneError(f"Obstacle {self.name!r} has no area.")
        if area_m2(corners) < 0.0:
            raise SceneError(f"Obstacle {self.name!r} has its corners clockwise: reverse them.")
        if not is_convex(corners):
            raise SceneError(
                f"Obstacle {self.name!r} is not convex: give it as several convex ones that touch."
            )


@dataclass(frozen=True)
class ScenePath:
    """A walk that people are asked to do, between two places of the scene."""

    name: str
    start: str
    goal: str


@dataclass(frozen=True, eq=False)
class Scene:
    """A floor with obstacles, named places and paths.

    Attributes:
        name, title: the key, and the displayed name.
        bounds_m: edges (left, near, right, far) of the rectangle in which people walk.
        obstacles: any number of obstacles, which may overlap.
        places: name -> point.
        paths: the paths in the order in which people walk them.
        clearance_m: smallest distance between the centre of mass and obstacles.
        about: the source of the geometry, and its assumptions.
    """

    name: str
    bounds_m: tuple[float, float, float, float]
    obstacles: tuple[Obstacle, ...] = ()
    places: Mapping[str, Point] = field(default_factory=dict)
    paths: tuple[ScenePath, ...] = ()
    clearance_m: float = CLEARANCE_M
    title: str = ""
    about: str = ""

    def __post_init__(self) -> None:
        """Raise SceneError if bounds, places or paths are invalid."""
        left, near, right, far = self.bounds_m
        if not (np.isfinite(self.bounds_m).all() and left < right and near < far):
            raise SceneError(f"Bounds {self.bounds_m} must be left < right, near < far, in metres.")
        if not 0.0 <= self.clearance_m < np.inf:
            raise SceneError(f"The clearance is {self.clearance_m} m; it must be 0 or more.")
        for name, point in self.places.items():
            self.check_point(point, f"Place {name!r}")
        for path in self.paths:
            for place in (path.start, path.goal):
                if place not in self.places:
                    existing = ", ".join(self.places) or "none"
                    raise SceneError(f"Path {path.name!r} names {place!r}; places are {existing}.")

    def check_point(self, point_m: Point, what: str) -> None:
        """Raise SceneError if a person cannot stand at a point; `what` begins the message."""
        left, near, right, far = self.bounds_m
        x, y = point_m
        if not np.isfinite(point_m).all():
            raise SceneError(f"{what} is at {point_m}: give two finite numbers, in metres.")
        if not (left <= x <= right and near <= y <= far):
            raise SceneError(
                f"{what} is at ({x:.3f}, {y:.3f}) m, outside the scene's bounds: x from {left:g} to"
                f" {right:g}, y from {near:g} to {far:g} m."
            )
        for obstacle in self.obstacles:
            if contains(obstacle.corners_m, np.array(point_m)):
                raise SceneError(
                    f"{what} is at ({x:.3f}, {y:.3f}) m, inside obstacle {obstacle.name!r}: move it"
                    " out, or correct the obstacle."
                )

    def widened_obstacles(self, *standing_m: Point) -> list[FloatArray]:
        """Return the outlines that an agent must not enter, given its start and goal."""
        if not any(self.is_near_obstacle(point) for point in standing_m):
            return self._widened
        return [
            widened(obstacle.corners_m, self._clearance_of(obstacle, standing_m))
            for obstacle in self.obstacles
        ]

    def is_near_obstacle(self, point_m: Point) -> bool:
        """Return whether a person standing at a point is within the clearance of an obstacle."""
        return any(contains(corners, np.array(point_m)) for corners in self._widened)

    @cached_property
    def _widened(self) -> list[FloatArray]:
        return [widened(obstacle.corners_m, self.clearance_m) for obstacle in self.obstacles]

    def _clearance_of(self, obstacle: Obstacle, standing_m: tuple[Point, ...]) -> float:
        clearance_m = self.clearance_m
        for point in standing_m:
            if contains(widened(obstacle.corners_m, clearance_m), np.array(point)):
                # At corners a widened outline is up to 2 % wider than its clearance.
                apart_m = distance_m(obstacle.corners_m, point)
                clearance_m = max(0.0, min(clearance_m, 0.98 * apart_m - NEAR_M))
        return clearance_m


def open_scene(*points_m: Point, margin_m: float = 0.5, name: str = "open floor") -> Scene:
    """Make a scene without obstacles around some points."""
    array = np.array(points_m)
    (left, near), (right, far) = array.min(axis=0) - margin_m, array.max(axis=0) + margin_m
    return Scene(name, (float(left), float(near), float(right), float(far)))


def box(name: str, centre_m: Point, size_m: Point, turned_deg: float = 0.0) -> Obstacle:
    """Make a rectangular obstacle of given width and depth, turned about its centre."""
    return Obstacle(name, box_corners(centre_m, size_m, turned_deg))
