"""Build convex pieces with few corners around many points, the same for the same set of points.

The hull of a body part may have hundreds of corners, and each costs time at every contact. So a
piece starts with the outermost points along 26 directions; the point farthest outside is added
repeatedly until every point is inside or at most `TOLERANCE_M` outside, or the piece has
`MAX_CORNERS` corners. The outermost points along 1000 directions are considered before all others.
The distance by which the farthest point remains outside is stored with the piece.

Points are first rounded to `GRID_M` and corners are listed in order, so the result depends neither
on the order of the points nor on a machine's last digit.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Final

import numpy as np

from app.science.rotations import FloatArray, Vector

if TYPE_CHECKING:
    from scipy.spatial import ConvexHull

MAX_CORNERS: Final = 128
TOLERANCE_M: Final = 0.001
GRID_M: Final = 1e-5
MIN_THICKNESS_M: Final = 0.001
"""Least thickness of a piece, as twice its volume over its surface: a thinner one is a sheet, which
nothing can rest against."""
_DIGITS = 5
_DIRECTIONS = np.array([row for row in product((-1.0, 0.0, 1.0), repeat=3) if any(row)])
_CANDIDATES = 1000


def _sphere_directions(count: int) -> FloatArray:
    """Return directions spread evenly over the sphere, on a golden-angle spiral, (count, 3)."""
    step = np.arange(count)
    turn, height = step * np.pi * (3.0 - np.sqrt(5.0)), 1.0 - (2.0 * step + 1.0) / count
    radius = np.sqrt(1.0 - height**2)
    return np.stack((radius * np.cos(turn), height, radius * np.sin(turn)), axis=1)


_SPHERE_DIRECTIONS = _sphere_directions(_CANDIDATES)


@dataclass(frozen=True)
class Piece:
    """A convex solid around the points of one body part.

    Attributes:
        corners_m: its corners in the frame of its part, in ascending order.
        outside_m: greatest distance by which one of the enclosed points lies outside.
    """

    corners_m: tuple[Vector, ...]
    outside_m: float

    def scaled(self, factor: float) -> "Piece":
        """Return the piece scaled by a factor, on the same grid."""
        corners = np.array(self.corners_m) * factor
        return Piece(_listed(corners), round(self.outside_m * factor, _DIGITS))

    def stretched(self, direction: Vector, factor: float) -> "Piece":
        """Return the piece stretched along a unit vector, away from its joint, on the same grid."""
        corners, along = np.array(self.corners_m), np.array(direction)
        stretched = corners + (factor - 1.0) * np.outer(corners @ along, along)
        return Piece(_listed(stretched), round(self.outside_m * max(factor, 1.0), _DIGITS))


def piece_of(points_m: FloatArray) -> Piece | None:
    """Return the piece around (N, 3) points; None if they are too few or enclose no volume."""
    # SciPy loads slowly, and a server that only writes models never needs it.
    from scipy.spatial import QhullError

    points = np.unique(np.round(points_m, _DIGITS), axis=0)
    if len(points) < 4:
        return None
    try:
        outer = _hull(points)
        if 2.0 * outer.volume < MIN_THICKNESS_M * outer.area:
            return None
        corners = points[np.sort(outer.vertices)]
        piece = _thinned(corners)
    except QhullError:
        return None
    return Piece(_listed(piece.points[piece.vertices]), _outside_m(piece, corners))


def _thinned(corners: FloatArray) -> "ConvexHull":
    if len(corners) <= MAX_CORNERS:
        return _hull(corners)
    considered = corners[_outermost(corners, _SPHERE_DIRECTIONS)]
    chosen = considered[_outermost(considered, _DIRECTIONS)]
    while True:
        hull = _hull(chosen)
        heights = _heights(hull, considered)
        if heights.max() <= TOLERANCE_M and considered is not corners:
            considered, heights = corners, _heights(hull, corners)
        if heights.max() <= TOLERANCE_M or len(chosen) >= MAX_CORNERS:
            return hull
        chosen = np.vstack((chosen, considered[int(np.argmax(heights))]))


def _outermost(points: FloatArray, directions: FloatArray) -> list[int]:
    """Return the sorted indices of the points that are outermost along any of the directions."""
    return sorted(set(np.argmax(directions @ points.T, axis=1).tolist()))


def _heights(hull: "ConvexHull", points: FloatArray) -> FloatArray:
    """Return how far each point lies outside the hull, (N,); negative for points inside.

    It is the greatest signed distance from the plane of a face.
    """
    normals, offsets = hull.equations[:, :3], hull.equations[:, 3]
    heights: FloatArray = (points @ normals.T + offsets).max(axis=1)
    return heights


def _outside_m(hull: "ConvexHull", points: FloatArray) -> float:
    return round(max(float(_heights(hull, points).max()), 0.0), _DIGITS)


def _hull(points: FloatArray) -> "ConvexHull":
    from scipy.spatial import ConvexHull

    return ConvexHull(points)


def _listed(corners: FloatArray) -> tuple[Vector, ...]:
    rows: Iterable[list[float]] = np.unique(np.round(corners, _DIGITS) + 0.0, axis=0).tolist()
    return tuple((x, y, z) for x, y, z in rows)
