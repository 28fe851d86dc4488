"""Compute with arrays of quaternions.

A rotation is a unit quaternion q = (w, x, y, z) = (cos(a/2), sin(a/2) u): a turn by the angle a
about the unit axis u, right-handed. q and -q are the same rotation. `multiply(a, b)` applies b
first and a second, so in `world_from_hand = multiply(world_from_arm, arm_from_hand)` neighbouring
frames match. Every function broadcasts over leading axes; angles are radians.

Source: Shoemake (1985), "Animating rotation with quaternion curves", SIGGRAPH 19:245-254.
"""

from itertools import pairwise
from typing import cast

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

# Below this angle sin(a)/a and its inverse are computed as series: the quotient loses digits.
_SMALL_ANGLE_RAD = 1e-6
_CONJUGATE: FloatArray = np.array((1.0, -1.0, -1.0, -1.0))
_EULER_LETTERS = frozenset("XYZ")


class RotationError(ValueError):
    """A value is not a rotation: zero length, wrong shape, or unknown Euler order."""


def identity(*shape: int) -> FloatArray:
    """Return the identity rotation, repeated: shape (*shape, 4)."""
    q = np.zeros((*shape, 4))
    q[..., 0] = 1.0
    return q


def multiply(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the Hamilton product a b, shape (..., 4), the rotation by b followed by a."""
    aw, ax, ay, az = a[..., 0], a[..., 1], a[..., 2], a[..., 3]
    bw, bx, by, bz = b[..., 0], b[..., 1], b[..., 2], b[..., 3]
    return np.stack(
        (
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ),
        axis=-1,
    )


def conjugate(q: FloatArray) -> FloatArray:
    """Return the inverse of unit quaternions, shape (..., 4)."""
    inverse: FloatArray = q * _CONJUGATE
    return inverse


def normalise(q: FloatArray) -> FloatArray:
    """Scale quaternions to unit length.

    Raises:
        RotationError: one of them has no direction (zero or not finite).
    """
    norm = np.linalg.norm(q, axis=-1, keepdims=True)
    if not bool(np.all(np.isfinite(norm) & (norm > 0.0))):
        raise RotationError(
            "A quaternion of zero or non-finite length cannot be normalised: leave that sample out."
        )
    return cast("FloatArray", q / norm)


def is_unit(q: FloatArray, tolerance: float = 1e-3) -> npt.NDArray[np.bool_]:
    """Return whether each quaternion is finite and of unit length within `tolerance`, (...)."""
    norm_squared = np.einsum("...i,...i->...", q, q)
    # |norm - 1| <= tolerance without a square root; comparisons with NaN are false.
    low, high = (1.0 - tolerance) ** 2, (1.0 + tolerance) ** 2
    return cast("npt.NDArray[np.bool_]", (norm_squared >= low) & (norm_squared <= high))


def rotate(q: FloatArray, vectors: FloatArray) -> FloatArray:
    """Rotate vectors (..., 3) by unit quaternions (..., 4): v + 2w(u x v) + 2 u x (u x v)."""
    w, x, y, z = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    vx, vy, vz = vectors[..., 0], vectors[..., 1], vectors[..., 2]
    cx, cy, cz = 2.0 * (y * vz - z * vy), 2.0 * (z * vx - x * vz), 2.0 * (x * vy - y * vx)
    return np.stack(
        (
            vx + w * cx + y * cz - z * cy,
            vy + w * cy + z * cx - x * cz,
            vz + w * cz + x * cy - y * cx,
        ),
        axis=-1,
    )


def matrices(q: FloatArray) -> FloatArray:
    """Return unit quaternions (..., 4) as rotation matrices (..., 3, 3)."""
    return np.swapaxes(rotate(q[..., np.newaxis, :], np.eye(3)), -1, -2)


def shortest(q: FloatArray, reference: FloatArray | None = None) -> FloatArray:
    """Return whichever of q and -q is nearer to `reference` (default: the identity)."""
    side = q[..., 0] if reference is None else np.einsum("...i,...i->...", q, reference)
    return np.where((side < 0.0)[..., np.newaxis], -q, q)


def from_rotation_vector(vector_rad: FloatArray) -> FloatArray:
    """Return the rotation about the direction of a vector (..., 3) by its length in radians."""
    angle = np.linalg.norm(vector_rad, axis=-1, keepdims=True)
    half = 0.5 * angle
    safe = np.where(angle < _SMALL_ANGLE_RAD, 1.0, angle)
    scale = np.where(angle < _SMALL_ANGLE_RAD, 0.5 - angle**2 / 48.0, np.sin(half) / safe)
    return np.concatenate((np.cos(half), scale * vector_rad), axis=-1)


def to_rotation_vector(q: FloatArray) -> FloatArray:
    """Return axis times angle (..., 3) of the shorter rotation: 0 <= angle <= pi."""
    positive = shortest(q)
    sine = np.sqrt(np.einsum("...i,...i->...", positive[..., 1:], positive[..., 1:]))
    angle = 2.0 * np.arctan2(sine, positive[..., 0])
    small = sine < _SMALL_ANGLE_RAD
    scale = np.where(small, 2.0, angle / np.where(small, 1.0, sine))
    return cast("FloatArray", scale[..., np.newaxis] * positive[..., 1:])


def geodesic_angle(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the angle in radians (...) of the shortest rotation from a to b: 0 to pi.

    The arctangent is accurate for tiny angles, where arccos of the dot product loses half its
    digits.
    """
    between = multiply(b, conjugate(a))
    sine = np.sqrt(np.einsum("...i,...i->...", between[..., 1:], between[..., 1:]))
    return cast("FloatArray", 2.0 * np.arctan2(sine, np.abs(between[..., 0])))


def slerp(a: FloatArray, b: FloatArray, fraction: npt.ArrayLike) -> FloatArray:
    """Interpolate from a (fraction 0) to b (fraction 1) at constant speed on the shorter arc.

    `fraction` has shape (...) without the quaternion axis and broadcasts. Fraction 0 gives a and
    fraction 1 gives b or -b, the same rotation, in the hemisphere of a.
    """
    t = np.asarray(fraction, dtype=np.float64)[..., np.newaxis]
    near = shortest(b, a)
    cosine = np.clip(np.einsum("...i,...i->...", a, near), -1.0, 1.0)[..., np.newaxis]
    angle = np.arccos(cosine)
    sine = np.sin(angle)
    straight = sine < _SMALL_ANGLE_RAD
    safe = np.where(straight, 1.0, sine)
    weight_a = np.where(straight, 1.0 - t, np.sin((1.0 - t) * angle) / safe)
    weight_b = np.where(straight, t, np.sin(t * angle) / safe)
    return weight_a * a + weight_b * near


def swing_between(start: FloatArray, end: FloatArray) -> FloatArray:
    """Return the shortest rotation that turns the direction `start` (..., 3) to `end` (..., 3).

    Half-vector form: q ~ (1 + v.k, v x k) for unit v, k. It needs no arccos and stays exact for
    close directions. For opposite directions the axis is any one perpendicular to `start`.

    Raises:
        RotationError: a direction has no length.
    """
    v, k = _unit(start), _unit(end)
    cosine = np.einsum("...i,...i->...", v, k)[..., np.newaxis]
    q = np.concatenate((1.0 + cosine, np.cross(v, k)), axis=-1)
    opposite = 1.0 + cosine < 1e-12
    if bool(np.any(opposite)):
        # The world axis least aligned with v gives a well-conditioned axis perpendicular to it.
        least = np.eye(3)[np.argmin(np.abs(v), axis=-1)]
        across = _unit(np.cross(v, least))
        half_turn = np.concatenate((np.zeros_like(cosine), across), axis=-1)
        q = np.where(opposite, half_turn, q)
    return normalise(q)


def _unit(vectors: FloatArray) -> FloatArray:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    if not bool(np.all(np.isfinite(length) & (length > 0.0))):
        raise RotationError("A direction has zero or non-finite length: leave it out.")
    return cast("FloatArray", vectors / length)


def _check_order(order: str) -> None:
    repeated = any(a == b for a, b in pairwise(order))
    if not 1 <= len(order) <= 3 or not _EULER_LETTERS.issuperset(order) or repeated:
        raise RotationError(
            f"{order!r} is not an Euler order: give one to three of X, Y, Z, such as 'ZYX',"
            " without a letter twice in a row."
        )


def from_euler(order: str, angles_rad: FloatArray) -> FloatArray:
    """Return q = q_1 q_2 q_3 for angles (..., len(order)) about the moving axes named in `order`.

    "ZYX" turns about Z, then about the new Y, then about the newest X (intrinsic). BVH channels
    listed as Zrotation Yrotation Xrotation have the same meaning.

    Raises:
        RotationError: an unknown order, or a last array dimension that is not len(order).
    """
    _check_order(order)
    if angles_rad.shape[-1] != len(order):
        raise RotationError(
            f"Order {order!r} needs {len(order)} angles, got {angles_rad.shape[-1]}."
        )
    flat = angles_rad.reshape(-1, len(order))
    from scipy.spatial.transform import Rotation  # slow to load, and rarely needed

    q = Rotation.from_euler(order, flat).as_quat(scalar_first=True)
    return np.asarray(q, dtype=np.float64).reshape(*angles_rad.shape[:-1], 4)


def to_euler(order: str, q: FloatArray) -> FloatArray:
    """Return the Euler angles (..., 3), radians, of which `from_euler` makes the same rotation.

    At a gimbal lock the third angle is set to zero, as only the sum or the difference of two angles
    is determined.

    Raises:
        RotationError: the order does not name three axes.
    """
    _check_order(order)
    if len(order) != 3:
        raise RotationError(f"{order!r} names {len(order)} axes: three are needed.")
    from scipy.spatial.transform import Rotation

    rotation = Rotation.from_quat(q.reshape(-1, 4), scalar_first=True)
    angles = rotation.as_euler(order, suppress_warnings=True)  # type: ignore[call-overload]  # stubs lag
    return np.asarray(angles, dtype=np.float64).reshape(*q.shape[:-1], 3)
