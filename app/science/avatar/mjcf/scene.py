"""The surroundings of the avatar: immovable boxes, boxes that fall, and the floor.

The world frame is the usual one: x right, y up, the participant faces -z, the floor is at zero;
metres.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from app.science.rotations import Vector
from app.science.tasks import SurfaceKind, TaskLayout

FLOOR = "floor"


@dataclass(frozen=True)
class SceneBox:
    """One immovable box whose edges are parallel to the world's axes.

    Attributes:
        name: the name of its geom; contacts are reported by this name.
        solid: whether it can be touched; a mark on the floor cannot.
    """

    name: str
    center_m: Vector
    half_size_m: Vector
    solid: bool = True


@dataclass(frozen=True)
class LooseBox:
    """One box that moves freely, and weighs nothing until it is dropped.

    In the model its body has `gravcomp` 1: it stays where it is. Setting that to zero drops it.

    Attributes:
        name: the name of its body, its joint and its geom.
    """

    name: str
    center_m: Vector
    half_size_m: Vector
    mass_kg: float


@dataclass(frozen=True)
class Scene:
    """The boxes around an avatar, with unique names, and whether there is a floor."""

    boxes: tuple[SceneBox, ...] = ()
    floor: bool = True
    loose: tuple[LooseBox, ...] = ()


FLOOR_ONLY = Scene()
"""A scene without boxes: only the floor."""


def scene_of(layouts: Iterable[TaskLayout], *, floor: bool = True) -> Scene:
    """Return the scene of a study's tasks, with a box for each surface of the layouts.

    An open box of a task becomes one box for its panel and one for each wall. Each is named after
    its surface (`hand/2/left`), so a contact names the surface that was touched. The start square
    is a mark on the floor that feet stand on, not an obstacle.
    """
    boxes = tuple(
        SceneBox(
            surface.key,
            surface.center_m,
            surface.half_size_m,
            solid=surface.kind is not SurfaceKind.START,
        )
        for layout in layouts
        for surface in layout.surfaces
    )
    return Scene(boxes, floor)
