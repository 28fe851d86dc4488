"""Estimate the pose of hips without a tracker, from a triangle of head, knees and hips.

Trunk and thighs are two rods that meet in the hips. With H the head's joint, K the midpoint between
the knees, L the length from hips to head and t the length from the hips to K, the hips lie on the
circle where two spheres intersect, and there at its rearmost point, since people bend forward:

    a = (L^2 - t^2 + d^2) / (2 d),   d = |K - H|,
    hips = H - a up + sqrt(L^2 - a^2) back,

`up` along K H and `back` perpendicular to it and to the body's right. For a person standing
upright, d exceeds the length of the rods: the hips then divide the line from H to K.

The thighs have equal lengths T, so their mean m and half difference s obey |m|^2 = T^2 - |s|^2
(parallelogram law); s follows from the distance of the knees and the breadth of the hips. So the
estimate is also right in a stride.

The body's right is the mean of the head's and the shins' right, projected to the horizontal: a
nodding head and a bent knee do not change it. The pelvis is aligned with the trunk. Without shins
the hips are placed straight below the head.

The estimate is a starting point and a weak preference; the solver moves the hips to where all limbs
together reach their goals best. Source: geometry; the choices named here are ours.
"""

from dataclasses import dataclass
from math import sqrt

from app.science.rotations import (
    Quaternion,
    Vector,
    q_from_axes,
    q_rotate,
    v_add,
    v_cross,
    v_dot,
    v_length,
    v_scale,
    v_subtract,
)

_RIGHT, _UP = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
_TINY = 1e-9


@dataclass(frozen=True)
class Trunk:
    """Lengths of one body's trunk and thighs in the T-pose.

    Attributes:
        hips_to_head_m: distance from the hips' joint to the head's.
        hips_to_sockets_m: height of the hips' joint above the hip sockets.
        half_breadth_m: distance from the median plane to a hip socket.
        thigh_m: distance from the hip socket to the knee.
    """

    hips_to_head_m: float
    hips_to_sockets_m: float
    half_breadth_m: float
    thigh_m: float


@dataclass(frozen=True)
class Tracked:
    """The pose of a tracked part: its joint's position in the world, and world_from_part."""

    position_m: Vector
    rotation: Quaternion


def estimated_hips(
    trunk: Trunk, head: Tracked, shins: tuple[Tracked, Tracked] | None
) -> tuple[Vector, Quaternion]:
    """Estimate position and orientation of the hips from the head and, if tracked, both shins."""
    right = _level_right(head, shins)
    if shins is None:
        place = v_subtract(head.position_m, v_scale(_UP, trunk.hips_to_head_m))
        return place, q_from_axes(right, _UP, v_cross(right, _UP))
    place = _triangle(trunk, head.position_m, shins, right)
    up = _unit(v_subtract(head.position_m, place), _UP)
    back = _unit(v_cross(right, up), (0.0, 0.0, 1.0))
    return place, q_from_axes(v_cross(up, back), up, back)


def _level_right(head: Tracked, shins: tuple[Tracked, Tracked] | None) -> Vector:
    x, _, z = q_rotate(head.rotation, _RIGHT)
    for shin in shins or ():
        shin_right = q_rotate(shin.rotation, _RIGHT)
        x, z = x + shin_right[0], z + shin_right[2]
    return _unit((x, 0.0, z), _RIGHT)


def _triangle(
    trunk: Trunk, head_m: Vector, shins: tuple[Tracked, Tracked], right: Vector
) -> Vector:
    left_knee, right_knee = shins[0].position_m, shins[1].position_m
    knees = v_scale(v_add(left_knee, right_knee), 0.5)
    half_difference = v_scale(v_subtract(right_knee, left_knee), 0.5)
    half_difference = v_subtract(half_difference, v_scale(right, trunk.half_breadth_m))
    thighs = sqrt(max(trunk.thigh_m * trunk.thigh_m - v_dot(half_difference, half_difference), 0.0))
    lower, upper = thighs + trunk.hips_to_sockets_m, trunk.hips_to_head_m
    line = v_subtract(head_m, knees)
    distance = v_length(line)
    up = _unit(line, _UP)
    if distance >= upper + lower or distance < _TINY:
        return v_subtract(head_m, v_scale(up, distance * upper / (upper + lower)))
    down_m = (upper * upper - lower * lower + distance * distance) / (2.0 * distance)
    back_m = sqrt(max(upper * upper - down_m * down_m, 0.0))
    back = _unit(v_cross(right, up), (0.0, 0.0, 1.0))
    return v_add(v_subtract(head_m, v_scale(up, down_m)), v_scale(back, back_m))


def _unit(v: Vector, default: Vector) -> Vector:
    length = v_length(v)
    return v_scale(v, 1.0 / length) if length > _TINY else default
