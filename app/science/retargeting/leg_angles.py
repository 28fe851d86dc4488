"""Angles of hip, knee and ankle over time, computed from joint positions alone.

Seen from the side, that is along the line between the hip joints:

- **hip**: thigh relative to the trunk (middle of the hip joints to the neck), forward is positive;
- **knee**: shin relative to the thigh, zero is a straight leg, bent is positive;
- **ankle**: foot (ankle to ball) relative to the shin, zero is a right angle, toes up is positive.

They need no rest pose and no joint frames, so captures of any kind can be compared. A standing
person's ankle angle is not zero, as the ball is lower than the ankle.
"""

from dataclasses import dataclass

import numpy as np

from app.science.retargeting.joint_map import JointMap
from app.science.retargeting.legs import Leg, Side, legs_of
from app.science.rig import RigError, RigMotion
from app.science.rotations import FloatArray

_TRUNK_ENDS = ("Neck", "UpperChest", "Head", "Chest")


@dataclass(frozen=True, eq=False)
class LegAngles:
    """Angles of one leg over time, each (N,) in radians; see the module for zero and sign."""

    side: Side
    hip_rad: FloatArray
    knee_rad: FloatArray
    ankle_rad: FloatArray


def leg_angles(motion: RigMotion, joint_map: JointMap) -> tuple[LegAngles, LegAngles]:
    """Compute the angles of both legs, left first.

    Raises:
        RigError: the legs, or all joints from chest to head, are not mapped.
    """
    legs = legs_of(motion.rig, joint_map)
    top = next((joint_map[name] for name in _TRUNK_ENDS if name in joint_map), None)
    if top is None:
        raise RigError("Hip angles are relative to the trunk: map the neck, head or a chest joint.")
    positions, world = motion.world()
    left, right = positions[:, legs.left.thigh], positions[:, legs.right.thigh]
    across = _unit(right - left)
    trunk = positions[:, motion.rig.index(top)] - (left + right) / 2.0
    return (
        _angles(legs.left, positions, world, across, trunk),
        _angles(legs.right, positions, world, across, trunk),
    )


def _angles(
    leg: Leg, positions_m: FloatArray, world: FloatArray, right: FloatArray, trunk: FloatArray
) -> LegAngles:
    hip, knee, ankle = (positions_m[:, joint] for joint in (leg.thigh, leg.shin, leg.foot))
    thigh, shin, foot = knee - hip, ankle - knee, leg.ball_m(positions_m, world) - ankle
    # Angles are positive if the rotation from the first to the second direction is forward.
    return LegAngles(
        side=leg.side,
        hip_rad=_forward_angle(-trunk, thigh, right),
        knee_rad=-_forward_angle(thigh, shin, right),
        # Relative to the direction perpendicular to the shin, so that the angle does not wrap
        # around.
        ankle_rad=_forward_angle(np.cross(right, shin), foot, right),
    )


def _forward_angle(start: FloatArray, end: FloatArray, right: FloatArray) -> FloatArray:
    """Return the angle (N,) from `start` to `end` about the axis to the right, -pi to pi."""
    flat_start, flat_end = _across(start, right), _across(end, right)
    sine = np.sum(np.cross(flat_start, flat_end) * right, axis=1)
    return np.asarray(np.arctan2(sine, np.sum(flat_start * flat_end, axis=1)))


def _across(vectors: FloatArray, axis: FloatArray) -> FloatArray:
    return np.asarray(vectors - np.sum(vectors * axis, axis=1, keepdims=True) * axis)


def _unit(vectors: FloatArray) -> FloatArray:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    if not bool(np.all(length > 1e-9)):
        raise RigError("The hip joints coincide, so the side view is undefined.")
    return np.asarray(vectors / length)
