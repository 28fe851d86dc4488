"""Convex outlines on the floor: boxes, discs, walls, and outlines widened by a clearance.

Corners are counter-clockwise, (K, 2). A disc is approximated by the regular polygon around it, so
that an obstacle is never smaller than its true shape. Inside means n . p < d for every edge with
outward normal n.
"""

import math

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records import BoolArray, Point

SIDES = 16
"""Number of corners of a disc; at the corners it is 2 % wider than the circle."""
FLAT_M2 = 1e-9
"""Area below which an outline counts as having none."""


def box_corners(centre_m: Point, size_m: Point, turned_deg: float = 0.0) -> FloatArray:
    """Make a rectangle of given width and depth, turned counter-clockwise about its centre."""
    half = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * np.array(size_m) / 2.0
    turn = math.radians(turned_deg)
    spin = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    corners: FloatArray = half @ spin + np.array(centre_m)
    return corners


def disc_corners(centre_m: Point, radius_m: float) -> FloatArray:
    """Make the regular polygon around a circle, its first edge facing to the right."""
    angles = (np.arange(SIDES) + 0.5) * (2.0 * math.pi / SIDES)
    around = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    corners: FloatArray = np.array(centre_m) + radius_m / math.cos(math.pi / SIDES) * around
    return corners


def wall_corners(start_m: Point, end_m: Point, thickness_m: float) -> FloatArray:
    """Return the corners of a wall between two points, with half its thickness on each side."""
    (x0, y0), (x1, y1) = start_m, end_m
    centre = ((x0 + x1) / 2.0, (y0 + y1) / 2.0)
    turned_deg = math.degrees(math.atan2(y1 - y0, x1 - x0))
    return box_corners(centre, (math.hypot(x1 - x0, y1 - y0), thickness_m), turned_deg)


def convex_hull(points_m: FloatArray) -> FloatArray:
    """Return the hull's corners counter-clockwise, without points on an edge (monotone chain)."""
    ordered = np.unique(points_m, axis=0)
    lower, upper = _chain(ordered), _chain(ordered[::-1])
    return np.array(lower[:-1] + upper[:-1])


def _chain(points: FloatArray) -> list[FloatArray]:
    chain: list[FloatArray] = []
    for point in points:
        while len(chain) > 1 and _cross(chain[-2], chain[-1], point) <= 1e-12:
            chain.pop()
        chain.append(point)
    return chain


def _cross(a: FloatArray, b: FloatArray, c: FloatArray) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def widened(corners_m: FloatArray, clearance_m: float) -> FloatArray:
    """Return the outline widened by the clearance on all sides.

    It is the Minkowski sum with a disc's polygon: a little wider at corners, never narrower.
    """
    if clearance_m <= 0.0:
        return corners_m
    disc = disc_corners((0.0, 0.0), clearance_m)
    return convex_hull((corners_m[:, None, :] + disc[None, :, :]).reshape(-1, 2))


def half_planes(corners_m: FloatArray) -> FloatArray:
    """Return rows (n_x, n_y, d) of each edge with unit outward normals, (K, 3)."""
    edges = np.roll(corners_m, -1, axis=0) - corners_m
    normals = np.stack([edges[:, 1], -edges[:, 0]], axis=-1)
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    offsets = (normals * corners_m).sum(axis=1)
    return np.column_stack([normals, offsets])


def contains(corners_m: FloatArray, points_m: FloatArray, *, margin_m: float = 0.0) -> BoolArray:
    """Return whether each point (..., 2) lies inside by more than the margin."""
    planes = half_planes(corners_m)
    depths = planes[:, 2] - np.asarray(points_m) @ planes[:, :2].T
    return np.asarray(depths.min(axis=-1) > margin_m, dtype=np.bool_)


def distance_m(corners_m: FloatArray, point_m: Point) -> float:
    """Return the distance of a point from an outline, 0 inside."""
    if contains(corners_m, np.array(point_m)):
        return 0.0
    starts, point = corners_m, np.array(point_m)
    edges = np.roll(corners_m, -1, axis=0) - starts
    shares = ((point - starts) * edges).sum(axis=1) / (edges * edges).sum(axis=1)
    nearest = starts + np.clip(shares, 0.0, 1.0)[:, None] * edges
    return float(np.linalg.norm(nearest - point, axis=1).min())


def area_m2(corners_m: FloatArray) -> float:
    """Return the area; negative if the corners are clockwise."""
    x, y = corners_m[:, 0], corners_m[:, 1]
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2.0)


def is_convex(corners_m: FloatArray) -> bool:
    """Return whether counter-clockwise corners never turn to the right."""
    edges = np.roll(corners_m, -1, axis=0) - corners_m
    after = np.roll(edges, -1, axis=0)
    turns = edges[:, 0] * after[:, 1] - edges[:, 1] * after[:, 0]
    total = np.abs(np.arctan2(turns, (edges * after).sum(axis=1))).sum()
    return bool((turns >= -1e-9).all() and total < 2.0 * math.pi + 1e-6)
