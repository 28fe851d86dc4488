"""Random scenes of boxes, discs and triangles on a floor, with two free places."""

import math

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records.protocols import Point
from app.science.walking.scene.scene import Obstacle, Scene, SceneError
from app.science.walking.scene.shapes import box_corners, convex_hull, disc_corners

SIDE_M = 4.0


def random_scene(rng: np.random.Generator) -> tuple[Scene, Point, Point]:
    """Return a 4 x 4 m floor with three to nine obstacles and two free places 2 m apart or more."""
    obstacles = tuple(
        Obstacle(f"obstacle {at}", _outline(rng)) for at in range(int(rng.integers(3, 10)))
    )
    scene = Scene("by chance", (0.0, 0.0, SIDE_M, SIDE_M), obstacles, clearance_m=0.1)
    while True:
        start, goal = _point(rng), _point(rng)
        if math.dist(start, goal) > 2.0 and _free(scene, start) and _free(scene, goal):
            return scene, start, goal


def _free(scene: Scene, point: Point) -> bool:
    try:
        scene.check_point(point, "A place")
    except SceneError:
        return False
    return not scene.is_near_obstacle(point)


def _point(rng: np.random.Generator) -> Point:
    x, y = rng.uniform(0.05, SIDE_M - 0.05, 2)
    return float(x), float(y)


def _outline(rng: np.random.Generator) -> FloatArray:
    centre, kind = _point(rng), rng.integers(3)
    if kind == 0:
        width, depth = rng.uniform(0.1, 1.5, 2)
        return box_corners(centre, (float(width), float(depth)), float(rng.uniform(0.0, 180.0)))
    if kind == 1:
        return disc_corners(centre, float(rng.uniform(0.05, 0.5)))
    while True:
        corners = convex_hull(np.array(centre) + rng.uniform(-0.6, 0.6, (3, 2)))
        if np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).min() > 0.1:
            return corners
