"""Inverse kinematics of arms and legs by the law of cosines, compiled.

Two bones of lengths a and b lead from a root to an end; the joint between them lies in the plane of
the root, the end and a pole, on the pole's side. With d the distance from root to end,

    cos(alpha) = (a^2 + d^2 - b^2) / (2 a d)

is the angle at the root between the direction to the end and the first bone. An end out of reach is
approached as far as possible: d is limited to |a - b| .. a + b, in the end's direction.

Importing this module loads the compiler.
"""

from math import sqrt
from typing import NamedTuple

from app.science import rotations
from app.science.compiled import compiled, compiled_inside
from app.science.rotations import Quaternion, Vector

v_cross, v_dot = compiled_inside(rotations.v_cross), compiled_inside(rotations.v_dot)
v_length, v_scale = compiled_inside(rotations.v_length), compiled_inside(rotations.v_scale)
q_from_axes = compiled_inside(rotations.q_from_axes)

_TINY_M = 1e-9
_FORWARD: Vector = (0.0, 0.0, -1.0)
_DOWN: Vector = (0.0, -1.0, 0.0)


class TwoBone(NamedTuple):
    """A solved limb, in world axes.

    Attributes:
        upper, lower: unit directions of the two bones.
        normal: unit normal of their plane: the direction to the end crossed with the pole's side.
        short_m: distance by which the end was out of reach; 0 if it is reached.
    """

    upper: Vector
    lower: Vector
    normal: Vector
    short_m: float


@compiled
def _across(way: Vector, pole: Vector) -> Vector:
    """Return the unit component of the pole across `way`, or of a spare pole if it has none."""
    for candidate in (pole, _FORWARD, _DOWN):
        along = v_dot(way, candidate)
        x = candidate[0] - along * way[0]
        y = candidate[1] - along * way[1]
        z = candidate[2] - along * way[2]
        length = sqrt(x * x + y * y + z * z)
        if length > 1e-3 * v_length(candidate):
            return (x / length, y / length, z / length)
    return (1.0, 0.0, 0.0)


@compiled
def solve_two_bone(
    root_m: Vector, end_m: Vector, upper_m: float, lower_m: float, pole: Vector
) -> TwoBone:
    """Place two bones from root towards end, bending towards the direction `pole`."""
    ex, ey, ez = end_m[0] - root_m[0], end_m[1] - root_m[1], end_m[2] - root_m[2]
    distance = sqrt(ex * ex + ey * ey + ez * ez)
    if distance < _TINY_M:
        ex, ey, ez, distance = 0.0, -_TINY_M, 0.0, _TINY_M
    way = (ex / distance, ey / distance, ez / distance)
    reach = min(max(distance, abs(upper_m - lower_m) + _TINY_M), upper_m + lower_m)
    side = _across(way, pole)
    cosine = (upper_m * upper_m + reach * reach - lower_m * lower_m) / (2.0 * upper_m * reach)
    cosine = min(1.0, max(-1.0, cosine))
    along, out = upper_m * cosine, upper_m * sqrt(1.0 - cosine * cosine)
    mx, my = along * way[0] + out * side[0], along * way[1] + out * side[1]
    mz = along * way[2] + out * side[2]
    fx, fy, fz = reach * way[0] - mx, reach * way[1] - my, reach * way[2] - mz
    return TwoBone(
        (mx / upper_m, my / upper_m, mz / upper_m),
        (fx / lower_m, fy / lower_m, fz / lower_m),
        v_cross(way, side),
        distance - reach,
    )


@compiled
def arm_rotation(bone: Vector, normal: Vector, side: float) -> Quaternion:
    """Return world_from_joint of an arm bone that points along `bone`.

    In the T-pose the right arm (side +1) runs along +x and the left (-1) along -x, and both elbows
    bend about y, forwards: so x is rotated to side * bone, and y to the bending axis of the elbow.
    """
    x_axis, y_axis = v_scale(bone, side), v_scale(normal, -side)
    return q_from_axes(x_axis, y_axis, v_cross(x_axis, y_axis))


@compiled
def hand_rotation(fingers: Vector, normal: Vector, side: float) -> Quaternion:
    """Return world_from_hand for fingers along a unit direction, with the least possible twist.

    `normal` is the normal of the arm's plane, as for `arm_rotation`.
    """
    along = v_dot(fingers, normal)
    flat = (
        normal[0] - along * fingers[0],
        normal[1] - along * fingers[1],
        normal[2] - along * fingers[2],
    )
    length = v_length(flat)
    across = v_scale(flat, 1.0 / length) if length > 1e-6 else _across(fingers, (1.0, 0.0, 0.0))
    return arm_rotation(fingers, across, side)


@compiled
def leg_rotation(bone: Vector, normal: Vector) -> Quaternion:
    """Return world_from_joint of a leg bone: in the T-pose it runs along -y and bends about x."""
    y_axis = (-bone[0], -bone[1], -bone[2])
    return q_from_axes(normal, y_axis, v_cross(normal, y_axis))
