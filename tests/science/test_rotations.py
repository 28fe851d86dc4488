"""Tests of quaternion algebra: products, vectors, Euler angles, slerp and swings."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.science import rotations as rot
from app.science.rotations import scalars
from app.science.rotations.scalars import Quaternion, Vector


@pytest.fixture
def rng() -> np.random.Generator:
    """Return random numbers with a fixed seed."""
    return np.random.default_rng(20200417)


def _random(rng: np.random.Generator, count: int = 200) -> rot.FloatArray:
    return rot.normalise(rng.normal(size=(count, 4)))


def _reference(q: rot.FloatArray) -> Rotation:
    return Rotation.from_quat(q, scalar_first=True)


def _tuple4(q: rot.FloatArray) -> Quaternion:
    w, x, y, z = q.tolist()
    return (w, x, y, z)


def _tuple3(v: rot.FloatArray) -> Vector:
    x, y, z = v.tolist()
    return (x, y, z)


def test_conjugate_undoes_a_rotation(rng: np.random.Generator) -> None:
    """A rotation times its conjugate is the identity."""
    q = _random(rng)
    np.testing.assert_allclose(rot.multiply(rot.conjugate(q), q), rot.identity(200), atol=1e-15)


def test_product_is_associative(rng: np.random.Generator) -> None:
    """The product of rotations is associative."""
    a, b, c = (_random(rng) for _ in range(3))
    left = rot.multiply(rot.multiply(a, b), c)
    np.testing.assert_allclose(left, rot.multiply(a, rot.multiply(b, c)), atol=1e-14)


def test_rotating_by_a_product_is_rotating_twice(rng: np.random.Generator) -> None:
    """Rotating by multiply(a, b) applies b first and a second."""
    a, b, v = _random(rng), _random(rng), rng.normal(size=(200, 3))
    np.testing.assert_allclose(
        rot.rotate(rot.multiply(a, b), v), rot.rotate(a, rot.rotate(b, v)), atol=1e-13
    )


def test_rotation_keeps_lengths_and_agrees_with_scipy(rng: np.random.Generator) -> None:
    """Rotated vectors keep their length and equal SciPy's."""
    q, v = _random(rng), rng.normal(size=(200, 3))
    turned = rot.rotate(q, v)
    np.testing.assert_allclose(np.linalg.norm(turned, axis=1), np.linalg.norm(v, axis=1))
    np.testing.assert_allclose(turned, _reference(q).apply(v), atol=1e-13)


@pytest.mark.parametrize("scale", [1e-12, 1e-7, 1e-3, 1.0, 3.1])
def test_rotation_vector_round_trip(rng: np.random.Generator, scale: float) -> None:
    """A rotation vector below half a turn, however small, survives conversion to a quaternion."""
    direction = rng.normal(size=(50, 3))
    vector = scale * direction / np.linalg.norm(direction, axis=1, keepdims=True)
    back = rot.to_rotation_vector(rot.from_rotation_vector(vector))
    np.testing.assert_allclose(back, vector, rtol=1e-9, atol=1e-18)


def test_rotation_vector_is_the_same_for_both_signs(rng: np.random.Generator) -> None:
    """q and -q give the same rotation vector."""
    q = _random(rng)
    np.testing.assert_allclose(rot.to_rotation_vector(-q), rot.to_rotation_vector(q), atol=1e-14)


@pytest.mark.parametrize("order", ["ZYX", "ZXY", "XYZ", "YXZ", "XZY", "YZX", "ZXZ"])
def test_euler_is_the_product_of_its_axes(rng: np.random.Generator, order: str) -> None:
    """An Euler order names rotations about moving axes, from left to right."""
    angles = rng.uniform(-1.4, 1.4, size=(40, 3))
    axes = np.eye(3)[["XYZ".index(letter) for letter in order]]
    first, second, third = (rot.from_rotation_vector(angles[:, [i]] * axes[i]) for i in range(3))
    q = rot.from_euler(order, angles)
    assert float(
        np.max(rot.geodesic_angle(q, rot.multiply(first, rot.multiply(second, third))))
    ) < (1e-12)
    back = rot.from_euler(order, rot.to_euler(order, q))
    assert float(np.max(rot.geodesic_angle(back, q))) < 1e-7


def test_slerp_ends_and_constant_speed(rng: np.random.Generator) -> None:
    """Slerp starts at a, ends at b and turns by equal angles in equal times."""
    a, b = _random(rng), _random(rng)
    total = rot.geodesic_angle(a, b)
    for fraction in (0.0, 0.25, 0.5, 1.0):
        way = rot.geodesic_angle(a, rot.slerp(a, b, fraction))
        np.testing.assert_allclose(way, fraction * total, atol=1e-9)


def test_slerp_takes_the_shorter_side() -> None:
    """Slerp takes the shorter way, whatever the sign of its end."""
    a, b = rot.identity(), rot.from_rotation_vector(np.array((0.4, 0.0, 0.0)))
    half = rot.from_rotation_vector(np.array((0.2, 0.0, 0.0)))
    assert float(rot.geodesic_angle(rot.slerp(a, -b, 0.5), half)) < 1e-12


def test_swing_brings_one_direction_onto_the_other(rng: np.random.Generator) -> None:
    """The swing maps start to end, about an axis perpendicular to both."""
    start, end = rng.normal(size=(500, 3)), rng.normal(size=(500, 3))
    q = rot.swing_between(start, end)
    unit = end / np.linalg.norm(end, axis=1, keepdims=True)
    moved = rot.rotate(q, start / np.linalg.norm(start, axis=1, keepdims=True))
    np.testing.assert_allclose(moved, unit, atol=1e-12)
    np.testing.assert_allclose(np.einsum("ij,ij->i", q[:, 1:], start), 0.0, atol=1e-12)


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (0.0, -2.0, 0.0), (0.3, 0.3, -0.9)])
def test_swing_of_opposite_directions_is_half_a_turn(axis: tuple[float, float, float]) -> None:
    """The swing between opposite directions is half a turn, without NaN."""
    start = np.array(axis)
    q = rot.swing_between(start, -start)
    np.testing.assert_allclose(rot.rotate(q, start), -start, atol=1e-12)
    assert float(rot.geodesic_angle(q, rot.identity())) == pytest.approx(np.pi)


def test_geodesic_angle_is_invariant_and_exact_when_tiny(rng: np.random.Generator) -> None:
    """The geodesic angle is invariant under a common rotation and exact at 1e-9 rad."""
    a, b, c = (_random(rng) for _ in range(3))
    np.testing.assert_allclose(
        rot.geodesic_angle(rot.multiply(c, a), rot.multiply(c, b)),
        rot.geodesic_angle(a, b),
        atol=1e-12,
    )
    tiny = rot.multiply(rot.from_rotation_vector(np.array((1e-9, 0.0, 0.0))), a)
    np.testing.assert_allclose(rot.geodesic_angle(a, tiny), 1e-9, rtol=1e-5)


def test_scalar_functions_agree_with_the_arrays(rng: np.random.Generator) -> None:
    """The functions of one quaternion as floats agree with those of arrays."""
    a, b, v = _random(rng), _random(rng), rng.normal(size=(200, 3))
    for i in range(200):
        p, q, vector = _tuple4(a[i]), _tuple4(b[i]), _tuple3(v[i])
        np.testing.assert_allclose(scalars.q_multiply(p, q), rot.multiply(a, b)[i], atol=1e-14)
        inverse = rot.multiply(rot.conjugate(a[i]), b[i])
        np.testing.assert_allclose(scalars.q_inverse_multiply(p, q), inverse, atol=1e-14)
        np.testing.assert_allclose(scalars.q_rotate(p, vector), rot.rotate(a, v)[i], atol=1e-13)
        middle = np.array(scalars.q_blend(p, q, 0.5))
        assert float(rot.geodesic_angle(middle, rot.slerp(a[i], b[i], 0.5))) < 1e-9
        columns = _reference(a[i]).as_matrix().T
        back = np.array(scalars.q_from_axes(*(_tuple3(column) for column in columns)))
        assert float(rot.geodesic_angle(back, a[i])) < 1e-12


def test_unit_check_flags_scaled_and_non_finite() -> None:
    """A scaled or non-finite quaternion is not a unit quaternion."""
    q = np.array([[1, 0, 0, 0], [1.1, 0, 0, 0], [np.nan, 0, 0, 1], [np.inf, 0, 0, 0]])
    assert rot.is_unit(q).tolist() == [True, False, False, False]


@pytest.mark.parametrize("order", ["", "ZZX", "zyx", "XYZX", "ABC"])
def test_unknown_euler_order_is_rejected(order: str) -> None:
    """An unknown Euler order raises an error that lists the valid ones."""
    with pytest.raises(rot.RotationError, match="Euler order"):
        rot.from_euler(order, np.zeros((1, max(len(order), 1))))


def test_values_without_direction_are_rejected() -> None:
    """Zero quaternions and zero directions raise an error instead of giving NaN."""
    with pytest.raises(rot.RotationError, match="cannot be normalised"):
        rot.normalise(np.zeros((2, 4)))
    with pytest.raises(rot.RotationError, match="non-finite length"):
        rot.swing_between(np.zeros(3), np.ones(3))
