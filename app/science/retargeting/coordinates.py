"""Convert positions and rotations between OptiTrack's and Unreal Engine's world.

OptiTrack (Motive, NatNet) is y up, right-handed, in metres; Unreal is z up, left-handed, in
centimetres. Exchanging y and z converts one to the other,

    p' = 100 (x, z, y),   q' = (w, -x, -z, -y):

the exchange mirrors space, so a rotation keeps its axis, with y and z exchanged, and reverses its
direction. A T-pose that faces +z in Motive, left arm on +x, faces +y in Unreal, left arm on +x.

Unreal prints rotations as FRotator, degrees of roll, pitch and yaw about x, y and z with its own
signs:

    q = Rz(yaw) Ry(-pitch) Rx(-roll).

With the textbook's Rz Ry Rx the mannequin's head would be below its pelvis.
"""

import numpy as np

from app.science.rotations import FloatArray, from_euler, normalise, to_euler

_CM_PER_M = 100.0
_Q_SIGNS = np.array((1.0, -1.0, -1.0, -1.0))


def unreal_from_optitrack(
    positions_m: FloatArray, rotations: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return positions (..., 3) in centimetres and rotations (..., 4) in Unreal's world.

    The arguments are metres and rotations in OptiTrack's world. Local rotations and world rotations
    are converted in the same way, as is every rotation that maps one frame to another.
    """
    return _CM_PER_M * positions_m[..., [0, 2, 1]], _Q_SIGNS * rotations[..., [0, 1, 3, 2]]


def optitrack_from_unreal(
    positions_cm: FloatArray, rotations: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return positions (..., 3) in metres and rotations (..., 4) in OptiTrack's world."""
    return positions_cm[..., [0, 2, 1]] / _CM_PER_M, _Q_SIGNS * rotations[..., [0, 1, 3, 2]]


def from_rotator(roll_pitch_yaw_deg: FloatArray) -> FloatArray:
    """Return the rotation (..., 4) of Unreal's roll, pitch and yaw (..., 3) in degrees."""
    roll_pitch_yaw = np.radians(roll_pitch_yaw_deg) * (-1.0, -1.0, 1.0)
    return from_euler("ZYX", np.asarray(roll_pitch_yaw[..., ::-1]))


def to_rotator(rotations: FloatArray) -> FloatArray:
    """Return Unreal's roll, pitch and yaw (..., 3) in degrees, with pitch within 90 degrees.

    At a pitch of 90 degrees, where only a sum of roll and yaw is determined, roll is zero.
    """
    yaw_pitch_roll = np.degrees(to_euler("ZYX", normalise(rotations)))
    return np.asarray(yaw_pitch_roll[..., ::-1] * (-1.0, -1.0, 1.0))
