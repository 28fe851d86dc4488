"""Scenes in which people walk: bounds, obstacles, places and paths.

`open_scene` is an empty floor, and `straight_scene` and `pole_scene` are the paper's laboratory.
`outlines_of` converts convex obstacles for the planners.
"""

from app.science.walking.scene.laboratory import (
    POLE_DEG,
    POLE_M,
    STRAIGHT_M,
    pole_scene,
    straight_scene,
)
from app.science.walking.scene.outlines import (
    BLOCKED,
    CLOSED,
    FREE,
    MOVED,
    TOUCH_M,
    IntArray,
    Lattice,
    Outlines,
    outlines_of,
)
from app.science.walking.scene.scene import (
    CLEARANCE_M,
    Obstacle,
    Scene,
    SceneError,
    ScenePath,
    open_scene,
)
from app.science.walking.scene.shapes import (
    FLAT_M2,
    area_m2,
    box_corners,
    contains,
    disc_corners,
    wall_corners,
)
from app.science.walking.scene.turning import SPACING_M, by_length, turning_per_m

__all__ = [
    "BLOCKED",
    "CLEARANCE_M",
    "CLOSED",
    "FLAT_M2",
    "FREE",
    "MOVED",
    "POLE_DEG",
    "POLE_M",
    "SPACING_M",
    "STRAIGHT_M",
    "TOUCH_M",
    "IntArray",
    "Lattice",
    "Obstacle",
    "Outlines",
    "Scene",
    "SceneError",
    "ScenePath",
    "area_m2",
    "box_corners",
    "by_length",
    "contains",
    "disc_corners",
    "open_scene",
    "outlines_of",
    "pole_scene",
    "straight_scene",
    "turning_per_m",
    "wall_corners",
]
