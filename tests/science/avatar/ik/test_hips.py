"""Tests of estimating the hips from the head and the shins."""

from math import radians

import numpy as np
import pytest

from app.science.avatar.ik.chain import Chain
from app.science.avatar.ik.goals import HEAD, LEFT_SHIN, RIGHT_SHIN
from app.science.avatar.ik.hips import Tracked, estimated_hips
from app.science.rotations import FloatArray, from_rotation_vector, geodesic_angle, multiply
from tests.science.avatar.ik import bodies

HIPS_M = np.array((0.4, 0.9, -0.3))
POSTURES: list[tuple[str, dict[str, float], float]] = [
    ("standing", {}, 0.0),
    ("a stride", {"LeftUpperLegX": 30.0, "RightUpperLegX": -14.0, "RightLowerLegX": 40.0}, 0.0),
    ("legs apart", {"LeftUpperLegZ": 25.0, "RightUpperLegZ": 25.0}, 0.0),
    ("sitting", {f"{s}{p}LegX": 90.0 for s in ("Left", "Right") for p in ("Upper", "Lower")}, 0.0),
    ("bent over", {"LeftUpperLegX": 60.0, "RightUpperLegX": 60.0}, 60.0),
    ("squatting", {"LeftUpperLegX": 120.0, "RightUpperLegX": 120.0}, 30.0),
]


@pytest.fixture
def chain() -> Chain:
    """Return the kinematic chain of the avatar."""
    return Chain(bodies.model())


@pytest.mark.parametrize(
    ("angles_deg", "lean_deg"), [p[1:] for p in POSTURES], ids=[p[0] for p in POSTURES]
)
@pytest.mark.parametrize("yaw", [0.0, 2.0, -3.0])
def test_hips_are_found_in_usual_postures(
    chain: Chain, angles_deg: dict[str, float], lean_deg: float, yaw: float
) -> None:
    """In usual postures the hips are found within 5 cm and 10 degrees, at any facing."""
    hips = _leaning(yaw, lean_deg)
    place, turn = _estimate(chain, angles_deg, hips)
    assert float(np.linalg.norm(place - HIPS_M)) < 0.05
    assert float(geodesic_angle(turn, hips)) < radians(10.0)


def test_hips_of_somebody_upright_are_exact(chain: Chain) -> None:
    """The estimated hips of a person standing upright, legs together or apart, are exact."""
    for angles_deg in ({}, {"LeftUpperLegZ": 20.0, "RightUpperLegZ": 20.0}):
        place, turn = _estimate(chain, angles_deg, _leaning(1.0, 0.0))
        np.testing.assert_allclose(place, HIPS_M, atol=1e-9)
        assert float(geodesic_angle(turn, _leaning(1.0, 0.0))) < 1e-7


def test_without_shins_the_hips_hang_below_the_head(chain: Chain) -> None:
    """Without shins the trunk is assumed to be upright and to face where the head faces."""
    hips = _leaning(0.5, 0.0)
    place, turn = _estimate(chain, {"LeftUpperLegX": 90.0}, hips, shins=False)
    np.testing.assert_allclose(place, HIPS_M, atol=1e-9)
    assert float(geodesic_angle(turn, hips)) < 1e-7


def test_impossible_bodies_have_hips_too(chain: Chain) -> None:
    """Impossible postures, such as a head between the knees, give finite hips."""
    for turn in ((1.0, 0.0, 0.0, 0.0), (0.5**0.5, 0.0, 0.0, 0.5**0.5)):
        everything = Tracked((0.0, 1.0, 0.0), turn)
        place, rotation = estimated_hips(chain.trunk, everything, (everything, everything))
        assert np.isfinite((*place, *rotation)).all()


def _estimate(
    chain: Chain, angles_deg: dict[str, float], hips: FloatArray, *, shins: bool = True
) -> tuple[FloatArray, FloatArray]:
    angles = np.array([radians(angles_deg.get(name, 0.0)) for name in chain.axis_names])
    goals = bodies.reached(chain, angles, HIPS_M, hips)
    seen = [
        Tracked(tuple(goals.positions_m[row].tolist()), tuple(goals.rotations[row].tolist()))
        for row in (HEAD, LEFT_SHIN, RIGHT_SHIN)
    ]
    place, turn = estimated_hips(chain.trunk, seen[0], (seen[1], seen[2]) if shins else None)
    return np.array(place), np.array(turn)


def _leaning(yaw: float, forward_deg: float) -> FloatArray:
    lean = from_rotation_vector(np.array((-radians(forward_deg), 0.0, 0.0)))
    return multiply(bodies.turned_hips(yaw), lean)
