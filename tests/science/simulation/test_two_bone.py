"""Tests of inverse kinematics of two-bone limbs, and smooth paths."""

import numpy as np
import pytest

from app.science import rotations as rot
from app.science.rotations.scalars import Vector
from app.science.simulation.paths import minimum_jerk, path_through
from app.science.simulation.two_bone import (
    TwoBone,
    arm_rotation,
    hand_rotation,
    leg_rotation,
    solve_two_bone,
)

_UPPER_M, _LOWER_M = 0.33, 0.26
_POLE: Vector = (0.3, -1.0, 0.2)


@pytest.fixture
def rng() -> np.random.Generator:
    """Return random numbers with a fixed seed."""
    return np.random.default_rng(5)


def _end(root: Vector, limb: TwoBone) -> rot.FloatArray:
    upper, lower = np.array(limb.upper), np.array(limb.lower)
    return np.asarray(np.array(root) + _UPPER_M * upper + _LOWER_M * lower)


def _vector(values: rot.FloatArray) -> Vector:
    x, y, z = values.tolist()
    return (x, y, z)


def test_a_reachable_end_is_met(rng: np.random.Generator) -> None:
    """An end within reach is met to a micrometre in any direction."""
    for _ in range(500):
        root, way = rng.normal(size=3), rng.normal(size=3)
        length = rng.uniform(_UPPER_M - _LOWER_M + 1e-3, _UPPER_M + _LOWER_M)
        end = root + length * way / np.linalg.norm(way)
        limb = solve_two_bone(_vector(root), _vector(end), _UPPER_M, _LOWER_M, _POLE)
        np.testing.assert_allclose(_end(_vector(root), limb), end, atol=1e-6)
        assert limb.short_m == pytest.approx(0.0, abs=1e-9)
        lengths = [
            np.linalg.norm(limb.upper),
            np.linalg.norm(limb.lower),
            np.linalg.norm(limb.normal),
        ]
        np.testing.assert_allclose(lengths, 1.0, atol=1e-9)


@pytest.mark.parametrize("length_m", [0.7, 5.0])
def test_an_end_out_of_reach_is_approached_straight(length_m: float) -> None:
    """A limb whose end is out of reach is straight and reports the missing length."""
    end = (0.0, 0.0, -length_m)
    limb = solve_two_bone((0.0, 0.0, 0.0), end, _UPPER_M, _LOWER_M, _POLE)
    assert limb.short_m == pytest.approx(length_m - _UPPER_M - _LOWER_M)
    np.testing.assert_allclose(_end((0.0, 0.0, 0.0), limb), (0.0, 0.0, -0.59), atol=1e-9)


def test_an_end_too_near_is_approached_as_far_as_the_bones_fold() -> None:
    """A limb whose end is too near folds and reports a negative missing length."""
    limb = solve_two_bone((0.0, 0.0, 0.0), (0.0, 0.0, -0.01), _UPPER_M, _LOWER_M, _POLE)
    assert limb.short_m == pytest.approx(0.01 - (_UPPER_M - _LOWER_M))


@pytest.mark.parametrize("pole", [(0.0, -1.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 0.0)])
def test_a_pole_along_the_limb_is_replaced(pole: Vector) -> None:
    """A pole along the limb, or of zero length, still gives a finite limb that reaches."""
    limb = solve_two_bone((0.0, 0.0, 0.0), (0.0, -0.4, 0.0), _UPPER_M, _LOWER_M, pole)
    np.testing.assert_allclose(_end((0.0, 0.0, 0.0), limb), (0.0, -0.4, 0.0), atol=1e-9)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_an_elbow_only_bends_the_way_elbows_do(side: float) -> None:
    """From the T-pose the forearm turns forwards, about y alone relative to the upper arm."""
    limb = solve_two_bone((0.0, 0.0, 0.0), (0.1, 0.0, -0.4), _UPPER_M, _LOWER_M, _POLE)
    upper = np.array(arm_rotation(limb.upper, limb.normal, side))
    lower = np.array(arm_rotation(limb.lower, limb.normal, side))
    bone = np.array((side, 0.0, 0.0))
    np.testing.assert_allclose(rot.rotate(upper, bone), limb.upper, atol=1e-12)
    np.testing.assert_allclose(rot.rotate(lower, bone), limb.lower, atol=1e-12)
    bend = rot.to_rotation_vector(rot.multiply(rot.conjugate(upper), lower))
    np.testing.assert_allclose(bend[[0, 2]], 0.0, atol=1e-9)
    assert side * float(bend[1]) > 0.1


def test_a_knee_only_bends_backwards() -> None:
    """The shank turns about -x alone relative to the thigh, so the heel moves backwards."""
    limb = solve_two_bone((0.0, 0.5, 0.0), (0.0, 0.0, -0.1), _UPPER_M, _LOWER_M, (0.0, 0.0, -1.0))
    upper = np.array(leg_rotation(limb.upper, limb.normal))
    lower = np.array(leg_rotation(limb.lower, limb.normal))
    bend = rot.to_rotation_vector(rot.multiply(rot.conjugate(upper), lower))
    np.testing.assert_allclose(bend[1:], 0.0, atol=1e-9)
    assert float(bend[0]) < -0.1


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_fingers_point_in_the_requested_direction(rng: np.random.Generator, side: float) -> None:
    """The hand's axis lies along the requested direction, even along the arm's normal."""
    for fingers in (*np.eye(3), rot.rotate(rot.normalise(rng.normal(size=4)), np.eye(3)[0])):
        q = np.array(hand_rotation(_vector(fingers), (0.0, 1.0, 0.0), side))
        np.testing.assert_allclose(rot.rotate(q, np.array((side, 0, 0))), fingers, atol=1e-9)


def test_minimum_jerk_known_values() -> None:
    """A minimum-jerk path is half way at half time, with a peak of 1.875 times the mean speed."""
    assert [minimum_jerk(s) for s in (-1.0, 0.0, 0.5, 1.0, 2.0)] == [0.0, 0.0, 0.5, 1.0, 1.0]
    slopes = [(minimum_jerk(s + 1e-6) - minimum_jerk(s - 1e-6)) / 2e-6 for s in (0.0, 0.5, 1.0)]
    np.testing.assert_allclose(slopes, (0.0, 1.875, 0.0), atol=1e-5)


def test_a_path_begins_ends_and_lasts_as_requested() -> None:
    """A path starts and ends at its way-points and takes exactly the requested time."""
    points: list[Vector] = [(0.0, 0.0, 0.0), (0.0, 0.3, 0.0), (0.5, 0.3, 0.0), (0.5, 0.0, 0.0)]
    path = path_through(points, 2.0, 1.2)
    assert path.end_s == pytest.approx(3.2)
    np.testing.assert_allclose(path.at(1.0), points[0])
    np.testing.assert_allclose(path.at(9.0), points[-1], atol=1e-12)
    heights = [path.at(2.0 + 0.01 * i)[1] for i in range(121)]
    assert max(heights) > 0.27


def test_waiting_puts_off_the_rest_of_a_path() -> None:
    """A path that waits before a leg stays in place until the wait is over."""
    points: list[Vector] = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0)]
    path = path_through(points, 0.0, 1.0).waiting_to_enter(1, 5.0)
    np.testing.assert_allclose(path.at(5.0), (1.0, 0.0, 0.0), atol=1e-12)
    np.testing.assert_allclose(path.at(9.0), (1.0, 1.0, 0.0), atol=1e-12)
