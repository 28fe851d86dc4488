"""Compute with quaternions and vectors as plain tuples, for work on a single frame.

A call of a NumPy function costs about a microsecond before it computes anything; one quaternion
product on floats costs less than that in total. The conventions are those of `arrays`.
"""

from math import acos, sin, sqrt

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]

IDENTITY: Quaternion = (1.0, 0.0, 0.0, 0.0)
_TINY_RAD = 1e-6


def q_multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the Hamilton product a b, the rotation by b followed by a."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def q_inverse_multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return a^-1 b: parent_from_joint for a = world_from_parent, b = world_from_joint."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw + ax * bx + ay * by + az * bz,
        aw * bx - ax * bw - ay * bz + az * by,
        aw * by + ax * bz - ay * bw - az * bx,
        aw * bz - ax * by + ay * bx - az * bw,
    )


def q_rotate(q: Quaternion, v: Vector) -> Vector:
    """Rotate a vector by a unit quaternion."""
    w, x, y, z = q
    vx, vy, vz = v
    cx, cy, cz = 2.0 * (y * vz - z * vy), 2.0 * (z * vx - x * vz), 2.0 * (x * vy - y * vx)
    return (
        vx + w * cx + y * cz - z * cy,
        vy + w * cy + z * cx - x * cz,
        vz + w * cz + x * cy - y * cx,
    )


def q_blend(a: Quaternion, b: Quaternion, fraction: float) -> Quaternion:
    """Interpolate from a to b along the shorter arc by a normalised linear blend.

    The path is that of slerp; only the speed along it differs, by under 1 % for 60 degrees.
    """
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    weight_a = 1.0 - fraction
    weight_b = fraction if aw * bw + ax * bx + ay * by + az * bz >= 0.0 else -fraction
    w, x = weight_a * aw + weight_b * bw, weight_a * ax + weight_b * bx
    y, z = weight_a * ay + weight_b * by, weight_a * az + weight_b * bz
    scale = 1.0 / sqrt(w * w + x * x + y * y + z * z)
    return (w * scale, x * scale, y * scale, z * scale)


def q_slerp(a: Quaternion, b: Quaternion, fraction: float) -> Quaternion:
    """Interpolate from a to b along the shorter arc at constant speed.

    Source: Shoemake (1985), "Animating rotation with quaternion curves", SIGGRAPH 19:245-254.
    """
    cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
    half = acos(min(1.0, abs(cosine)))
    if half < _TINY_RAD:
        return q_blend(a, b, fraction)
    weight_a = sin((1.0 - fraction) * half) / sin(half)
    weight_b = sin(fraction * half) / sin(half) * (1.0 if cosine >= 0.0 else -1.0)
    w, x, y, z = (weight_a * one + weight_b * other for one, other in zip(a, b, strict=True))
    return (w, x, y, z)


def q_from_axes(x_axis: Vector, y_axis: Vector, z_axis: Vector) -> Quaternion:
    """Return the rotation whose matrix has these orthonormal, right-handed columns.

    Source: Shepperd (1978), "Quaternion from rotation matrix", J. Guidance and Control 1:223-224:
    divide by the largest component, so that no digits are lost.
    """
    (m00, m10, m20), (m01, m11, m21), (m02, m12, m22) = x_axis, y_axis, z_axis
    trace = m00 + m11 + m22
    if trace > m00 and trace > m11 and trace > m22:
        s = 2.0 * sqrt(1.0 + trace)
        return (0.25 * s, (m21 - m12) / s, (m02 - m20) / s, (m10 - m01) / s)
    if m00 >= m11 and m00 >= m22:
        s = 2.0 * sqrt(1.0 + m00 - m11 - m22)
        return ((m21 - m12) / s, 0.25 * s, (m01 + m10) / s, (m02 + m20) / s)
    if m11 >= m22:
        s = 2.0 * sqrt(1.0 + m11 - m00 - m22)
        return ((m02 - m20) / s, (m01 + m10) / s, 0.25 * s, (m12 + m21) / s)
    s = 2.0 * sqrt(1.0 + m22 - m00 - m11)
    return ((m10 - m01) / s, (m02 + m20) / s, (m12 + m21) / s, 0.25 * s)


def v_add(a: Vector, b: Vector) -> Vector:
    """Return a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def v_subtract(a: Vector, b: Vector) -> Vector:
    """Return a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def v_scale(v: Vector, factor: float) -> Vector:
    """Return the vector multiplied by a number."""
    return (v[0] * factor, v[1] * factor, v[2] * factor)


def v_dot(a: Vector, b: Vector) -> float:
    """Return the scalar product of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def v_cross(a: Vector, b: Vector) -> Vector:
    """Return the vector product a x b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def v_length(v: Vector) -> float:
    """Return the Euclidean length of a vector."""
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
