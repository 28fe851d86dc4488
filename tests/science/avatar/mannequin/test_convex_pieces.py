"""Tests of how closely one convex piece per part follows the skin; it cannot follow holes."""

import json
from functools import cache

import numpy as np
import pytest
from scipy.spatial import ConvexHull, cKDTree

from app.protocol.humanoid import parse_figure
from app.resources import bodies_dir
from app.science.avatar.body import FINGER_PARTS, Figure, proportions
from app.science.avatar.body.hulls import piece_of
from app.science.avatar.mannequin import Mannequin, make_mannequin
from app.science.rotations import FloatArray

_PARTS_OF_AN_EDGE = 4
RING_M, TUBE_M, FINGER_M = 0.016, 0.003, 0.008
"""The middle radius of a ring, half its thickness, and half the thickness of a finger."""


@cache
def figure() -> Figure:
    """Return the measures of the neutral body."""
    measures = json.loads((bodies_dir() / "neutral.json").read_text(encoding="utf-8"))
    return parse_figure(measures["figure"])


@cache
def mannequin() -> Mannequin:
    """Return the neutral body."""
    return make_mannequin(proportions(1.75))


def sampled(points: FloatArray, triangles: np.ndarray) -> tuple[FloatArray, np.ndarray]:
    """Return places spread over triangles, and the triangle of each."""
    corners = [points[triangles[:, n]] for n in range(3)]
    found, steps = [], _PARTS_OF_AN_EDGE
    for one in range(steps + 1):
        for other in range(steps + 1 - one):
            shares = (1.0 - (one + other) / steps, one / steps, other / steps)
            found.append(sum(share * corner for share, corner in zip(shares, corners, strict=True)))
    return np.concatenate(found), np.tile(np.arange(len(triangles)), len(found))


def beyond_the_skin_mm() -> dict[str, float]:
    """Return how far the piece of each part stands out from the skin of the whole body at most."""
    made, measured = mannequin(), figure()
    places, owners = sampled(made.points_m, made.triangles)
    edges = [made.points_m[made.triangles[:, n]] for n in range(3)]
    normals = np.cross(edges[1] - edges[0], edges[2] - edges[0])
    tree = cKDTree(places)
    found = {}
    for part, piece in measured.pieces.items():
        corners = np.array(piece.corners_m) + measured.places_m[part]
        on_piece, _ = sampled(corners, ConvexHull(corners).simplices)
        distances, nearest = tree.query(on_piece)
        away = np.einsum("ij,ij->i", on_piece - places[nearest], normals[owners[nearest]])
        found[part] = 1000.0 * float(np.where(away > 0.0, distances, 0.0).max())
    return found


def test_pieces_stand_out_little_from_the_skin() -> None:
    """One piece a part stands out from the skin by at most 20 mm, at fingers by at most 2 mm.

    Farthest out they are in hollows: armpit, nape, hollow of the knee. Half of the parts are within
    4 mm. Of fingers the two outer segments count, with which people touch.
    """
    found = beyond_the_skin_mm()
    assert max(found.values()) < 20.0
    outer = [part for part in FINGER_PARTS if not part.endswith("Proximal")]
    assert max(found[part] for part in outer) < 2.0
    assert float(np.median(list(found.values()))) < 4.0
    assert max(piece.outside_m for piece in figure().pieces.values()) < 0.003


def test_one_piece_closes_a_ring() -> None:
    """A ring that is one part is a disc as one piece: a finger that fits into it cannot pass.

    Cut into twelve parts it stays open, as a ring of two fingers does, whose parts are six.
    """
    around, across = np.meshgrid(np.linspace(0, 2 * np.pi, 48), np.linspace(0, 2 * np.pi, 16))
    reach = RING_M + TUBE_M * np.cos(across)
    ring = np.stack(
        (reach * np.cos(around), TUBE_M * np.sin(across), reach * np.sin(around)), axis=-1
    ).reshape(-1, 3)
    assert free_m([ring]) < 0.0
    sectors = np.floor((np.arctan2(ring[:, 2], ring[:, 0]) + np.pi) / (2 * np.pi) * 12).clip(0, 11)
    cut = [ring[(sectors == n) | (sectors == (n + 1) % 12)] for n in range(12)]
    assert free_m(cut) == pytest.approx(RING_M - TUBE_M, abs=0.0021)
    assert free_m(cut) > FINGER_M


def free_m(parts: list[FloatArray]) -> float:
    """Return the radius of the free space around the origin between the pieces of some parts."""
    distances = []
    for points in parts:
        piece = piece_of(points)
        assert piece is not None
        equations = ConvexHull(np.array(piece.corners_m)).equations
        distances.append(float(equations[:, 3].max()))
    return min(distances)
