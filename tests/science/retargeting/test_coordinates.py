"""Tests of coordinates of OptiTrack and of Unreal, and Unreal's Euler angles."""

import numpy as np
import pytest

from app.science.retargeting.coordinates import (
    from_rotator,
    optitrack_from_unreal,
    to_rotator,
    unreal_from_optitrack,
)
from app.science.rotations import geodesic_angle, multiply, normalise, rotate


@pytest.fixture
def rng() -> np.random.Generator:
    """Return random numbers with a fixed seed."""
    return np.random.default_rng(4)


def test_converting_there_and_back_changes_nothing(rng: np.random.Generator) -> None:
    """Converting to another coordinate system and back changes nothing."""
    places, q = rng.normal(size=(50, 3)), normalise(rng.normal(size=(50, 4)))
    places_back, q_back = optitrack_from_unreal(*unreal_from_optitrack(places, q))
    np.testing.assert_allclose(places_back, places, atol=1e-15)
    np.testing.assert_array_equal(q_back, q)


def test_turning_and_converting_can_be_exchanged(rng: np.random.Generator) -> None:
    """Converting a turned point equals turning the converted point by the converted rotation."""
    places, q = rng.normal(size=(50, 3)), normalise(rng.normal(size=(50, 4)))
    unreal_cm, unreal_q = unreal_from_optitrack(places, q)
    turned_cm, _ = unreal_from_optitrack(rotate(q, places), q)
    np.testing.assert_allclose(rotate(unreal_q, unreal_cm), turned_cm, atol=1e-12)


def test_a_product_of_rotations_is_converted_factor_by_factor(rng: np.random.Generator) -> None:
    """A product of rotations converts factor by factor, so local rotations convert as well."""
    a, b = normalise(rng.normal(size=(2, 50, 4)))
    origin = np.zeros((50, 3))
    product = unreal_from_optitrack(origin, multiply(a, b))[1]
    factors = [unreal_from_optitrack(origin, q)[1] for q in (a, b)]
    np.testing.assert_allclose(multiply(*factors), product, atol=1e-15)


def test_a_t_pose_of_motive_faces_unreals_y() -> None:
    """Facing +z with the left arm on +x in Motive is facing +y with the left arm on +x in Unreal.

    One metre becomes a hundred centimetres, and up is z.
    """
    forward_left_up = np.array(((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    unreal, _ = unreal_from_optitrack(forward_left_up, np.array((1.0, 0.0, 0.0, 0.0)))
    np.testing.assert_array_equal(unreal, 100.0 * np.eye(3)[[1, 0, 2]])


def test_a_rotator_is_yaw_then_pitch_then_roll_with_unreals_signs() -> None:
    """Positive yaw turns x to y, positive pitch raises x to z, positive roll lowers y."""
    x, y = np.eye(3)[:2]
    yaw, pitch, roll = (np.array(a) for a in ((0, 0, 90.0), (0, 90.0, 0), (90.0, 0, 0)))
    np.testing.assert_allclose(rotate(from_rotator(yaw), x), (0, 1, 0), atol=1e-15)
    np.testing.assert_allclose(rotate(from_rotator(pitch), x), (0, 0, 1), atol=1e-15)
    np.testing.assert_allclose(rotate(from_rotator(roll), y), (0, 0, -1), atol=1e-15)


def test_a_rotator_comes_back(rng: np.random.Generator) -> None:
    """A rotation converted to Unreal's angles and back is the same rotation."""
    q = normalise(rng.normal(size=(200, 4)))
    assert float(np.max(geodesic_angle(from_rotator(to_rotator(q)), q))) < 1e-12
