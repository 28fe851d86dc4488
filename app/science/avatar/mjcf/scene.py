"""What stands around the avatar: immovable boxes and the floor.

World frame as everywhere: x right, y up, the participant faces -z, the floor at zero; metres.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from app.science.rotations import Vector
from app.science.tasks import SurfaceKind, TaskLayout

FLOOR = "floor"


@dataclass(frozen=True)
class SceneBox:
    """One immovable block, parallel to the world's axes.

    Attributes:
        name: of its geom; contacts are told by it.
        solid: whether it can be touched; a mark on the floor is not.
    """

    name: str
    center_m: Vector
    half_size_m: Vector
    solid: bool = True


@dataclass(frozen=True)
class Scene:
    """Blocks, and whether there is a floor; names of blocks differ from each other."""

    boxes: tuple[SceneBox, ...] = ()
    floor: bool = True


FLOOR_ONLY = Scene()
"""An empty room."""


def scene_of(layouts: Iterable[TaskLayout], *, floor: bool = True) -> Scene:
    """Return the boxes of a study's tasks: an open box is its panel and its walls.

    A block is named after its surface (`hand/2/left`), so a contact names what was touched. The
    start square is a mark on the floor that feet stand on, not an obstacle.
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
