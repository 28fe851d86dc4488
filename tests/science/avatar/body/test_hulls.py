"""Tests that convex pieces enclose their points, have few corners and are deterministic."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from app.science.avatar.body.hulls import MAX_CORNERS, TOLERANCE_M, Piece, piece_of
from app.science.rotations import FloatArray

GRID_M = 1e-5


def cloud(seed: int, count: int, size_m: float = 0.1) -> FloatArray:
    """Return random points on the surface of a dented ball."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(count, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    return np.asarray(size_m * points * rng.uniform(0.7, 1.0, (count, 1)))


def outside_m(piece: Piece, points: FloatArray) -> float:
    """Return how far the farthest point lies outside of the piece, in metres."""
    hull = ConvexHull(np.array(piece.corners_m))
    heights = points @ hull.equations[:, :3].T + hull.equations[:, 3]
    return max(float(heights.max()), 0.0)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.integers(0, 10_000), st.integers(8, 3_000), st.floats(0.01, 0.3))
def test_a_piece_encloses_its_points(seed: int, count: int, size_m: float) -> None:
    """A convex piece encloses its points to its stated tolerance, 1 mm if its corners suffice."""
    points = cloud(seed, count, size_m)
    piece = piece_of(points)
    assert piece is not None
    assert outside_m(piece, points) <= piece.outside_m + 2.0 * GRID_M
    assert len(piece.corners_m) <= MAX_CORNERS
    if len(piece.corners_m) < MAX_CORNERS - 1:
        assert piece.outside_m <= TOLERANCE_M


def test_a_box_is_its_corners() -> None:
    """The convex piece of a box has just the box's eight corners, whatever points lie inside."""
    rng = np.random.default_rng(1)
    inside = rng.uniform(-0.05, 0.05, (500, 3))
    corners = [(x, y, z) for x in (-0.05, 0.05) for y in (-0.05, 0.05) for z in (-0.05, 0.05)]
    piece = piece_of(np.vstack((inside, np.array(corners))))
    assert piece == Piece(tuple(corners), 0.0)


def test_a_piece_does_not_depend_on_order_or_rounding() -> None:
    """Shuffled and slightly perturbed points give the same corners in the same order."""
    points = cloud(2, 800)
    rng = np.random.default_rng(3)
    grid = np.round(points, 5)
    shuffled = rng.permutation(grid) + rng.uniform(-1e-7, 1e-7, grid.shape)
    assert piece_of(grid) == piece_of(shuffled)
    piece = piece_of(points)
    assert piece is not None
    assert list(piece.corners_m) == sorted(piece.corners_m)


@pytest.mark.parametrize(
    "points",
    [
        np.zeros((0, 3)),
        np.zeros((100, 3)),
        cloud(4, 3),
        cloud(4, 100) * (1.0, 1.0, 0.0),
        cloud(4, 100) * (1.0, 0.0, 0.0),
        cloud(4, 100) * (1.0, 1.0, 0.003),
        cloud(4, 100, 1e-4),
    ],
)
def test_points_without_volume_have_no_piece(points: FloatArray) -> None:
    """Empty, coincident, collinear, coplanar and tiny sets of points have no convex piece."""
    assert piece_of(points) is None


def test_a_piece_grows_with_its_body() -> None:
    """Points scaled by two give corners twice as far out, to the resolution of the grid."""
    piece = piece_of(cloud(5, 60))
    assert piece is not None
    assert np.allclose(piece.scaled(2.0).corners_m, 2.0 * np.array(piece.corners_m), atol=GRID_M)
