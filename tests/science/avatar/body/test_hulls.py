"""Convex pieces: they hold their points, have few corners, and are always the same."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from app.science.avatar.body.hulls import MAX_CORNERS, TOLERANCE_M, Piece, piece_of
from app.science.rotations import FloatArray

GRID_M = 1e-5


def cloud(seed: int, count: int, size_m: float = 0.1) -> FloatArray:
    """Points on a dented ball."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(count, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    return np.asarray(size_m * points * rng.uniform(0.7, 1.0, (count, 1)))


def outside_m(piece: Piece, points: FloatArray) -> float:
    """How far the farthest point is outside of the piece."""
    hull = ConvexHull(np.array(piece.corners_m))
    heights = points @ hull.equations[:, :3].T + hull.equations[:, 3]
    return max(float(heights.max()), 0.0)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.integers(0, 10_000), st.integers(8, 3_000), st.floats(0.01, 0.3))
def test_a_piece_holds_its_points(seed: int, count: int, size_m: float) -> None:
    """All of them to within what it says of itself, which is a millimetre if corners suffice."""
    points = cloud(seed, count, size_m)
    piece = piece_of(points)
    assert piece is not None
    assert outside_m(piece, points) <= piece.outside_m + 2.0 * GRID_M
    assert len(piece.corners_m) <= MAX_CORNERS
    if len(piece.corners_m) < MAX_CORNERS - 1:
        assert piece.outside_m <= TOLERANCE_M


def test_a_box_is_its_corners() -> None:
    """Points inside and on the faces of a box add nothing."""
    rng = np.random.default_rng(1)
    inside = rng.uniform(-0.05, 0.05, (500, 3))
    corners = [(x, y, z) for x in (-0.05, 0.05) for y in (-0.05, 0.05) for z in (-0.05, 0.05)]
    piece = piece_of(np.vstack((inside, np.array(corners))))
    assert piece == Piece(tuple(corners), 0.0)


def test_neither_order_nor_a_last_digit_decides() -> None:
    """The same corners in the same order."""
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
def test_what_encloses_nothing_has_no_piece(points: FloatArray) -> None:
    """Nothing, a point, a line, a sheet, a crumb."""
    assert piece_of(points) is None


def test_a_piece_grows_with_its_body() -> None:
    """Twice as large, on the same grid."""
    piece = piece_of(cloud(5, 60))
    assert piece is not None
    assert np.allclose(piece.scaled(2.0).corners_m, 2.0 * np.array(piece.corners_m), atol=GRID_M)
