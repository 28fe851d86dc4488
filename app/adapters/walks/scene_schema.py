"""The schema of scene files; lengths in metres, angles in degrees."""

from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from app.science.rotations import FloatArray
from app.science.walking.records import Point
from app.science.walking.scene import CLEARANCE_M, Obstacle, box_corners, disc_corners, wall_corners

FARTHEST_M = 1000.0
MOST_OBSTACLES, MOST_PLACES, MOST_PATHS, MOST_CORNERS = 200, 200, 500, 64

Coordinate = Annotated[float, Field(ge=-FARTHEST_M, le=FARTHEST_M, allow_inf_nan=False)]
Size = Annotated[float, Field(ge=0.001, le=FARTHEST_M, allow_inf_nan=False)]
Name = Annotated[str, Field(min_length=1, max_length=80)]
Place = tuple[Coordinate, Coordinate]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, populate_by_name=True)


class _Shape(_Strict):
    name: Name

    def corners(self) -> FloatArray:
        """Return the corners of the outline, counter-clockwise."""
        raise NotImplementedError

    def obstacle(self) -> Obstacle:
        """Return the obstacle; raise SceneError for an invalid outline."""
        return Obstacle(self.name, self.corners())


class Box(_Shape):
    """A rectangle of width and depth, rotated counter-clockwise about its centre."""

    shape: Literal["box"]
    center_m: Place
    size_m: tuple[Size, Size]
    turned_deg: Annotated[float, Field(ge=-360.0, le=360.0, allow_inf_nan=False)] = 0.0

    def corners(self) -> FloatArray:
        """Return the four corners of the rectangle."""
        return box_corners(self.center_m, self.size_m, self.turned_deg)


class Disc(_Shape):
    """A round obstacle, such as a pole."""

    shape: Literal["disc"]
    center_m: Place
    radius_m: Size

    def corners(self) -> FloatArray:
        """Return the corners of the polygon around the circle."""
        return disc_corners(self.center_m, self.radius_m)


class Wall(_Shape):
    """A straight wall between two points."""

    shape: Literal["wall"]
    from_m: Place
    to_m: Place
    thickness_m: Size

    def corners(self) -> FloatArray:
        """Return the corners of the wall, with half of the thickness on each side."""
        return wall_corners(self.from_m, self.to_m, self.thickness_m)


class Polygon(_Shape):
    """A convex obstacle with the given corners, counter-clockwise."""

    shape: Literal["polygon"]
    corners_m: Annotated[tuple[Place, ...], Field(min_length=3, max_length=MOST_CORNERS)]

    def corners(self) -> FloatArray:
        """Return the corners as given."""
        return np.array(self.corners_m, dtype=np.float64)


class Way(_Strict):
    """A path that participants are asked to walk."""

    name: Name
    start: Name = Field(alias="from")
    goal: Name = Field(alias="to")


class SceneFile(_Strict):
    """The content of a scene file."""

    key: Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9-]{0,63}$")]
    title: Annotated[str, Field(max_length=200)] = ""
    about: Annotated[str, Field(max_length=5000)] = ""
    clearance_m: Annotated[float, Field(ge=0.0, le=5.0, allow_inf_nan=False)] = CLEARANCE_M
    bounds_m: tuple[Coordinate, Coordinate, Coordinate, Coordinate] = Field(
        description="left, near, right, far"
    )
    obstacles: Annotated[
        tuple[Annotated[Box | Disc | Wall | Polygon, Field(discriminator="shape")], ...],
        Field(max_length=MOST_OBSTACLES),
    ] = ()
    places: Annotated[dict[Name, Place], Field(max_length=MOST_PLACES)] = Field(
        default_factory=dict
    )
    paths: Annotated[tuple[Way, ...], Field(max_length=MOST_PATHS)] = ()


def point_of(place: Place) -> Point:
    """Convert a place to a point of `app.science.walking`."""
    return float(place[0]), float(place[1])
