"""Compute the reference pose of a physics avatar: the one its hinges would reach without limits.

The participant's own rotations are the wrong reference for such an avatar. Its shoulders have no
hinge, its elbows and knees bend in one plane, and rotations that these cannot make are transferred
to their neighbours, so that hands, feet and head still point where the participant's do
(`targets`). Against the raw rotations, an avatar that reaches its targets exactly would have an
error in both neighbours, of the same angle in opposite directions: after a shrug by 20 degrees, in
the shoulder and in the upper arm, although the arm is where it should be. So joint errors are
computed from the target rotations of the hinges, joint by joint, before their limits
(`TargetAngles.unclamped_rad`).

This reference does not include:

- The limits. What they cut off is error, and is also counted in `Clipping`. A locked hinge, such as
  a human elbow's third axis or a limb in a cast, may have a target that it cannot reach: that is
  error too. It is not counted as clipped, since it is not driven.
- In a configuration with targets in the world, the way in which head and arms give way when the
  trunk is pushed aside (`following`). It follows from the avatar's own movement, so it is not part
  of the target.

Fingers belong to the reference where they are recorded.

None of this applies to a delayed copy, which repeats the participant's rotations.
"""

from collections.abc import Collection, Mapping

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import AXES, PART_NAMES
from app.science.avatar.targets.targets import (
    Limits,
    TargetAngles,
    finger_rotations,
    joint_rotations,
)
from app.science.joint_error import ERROR_JOINTS_WITH_FINGERS, Clipping, ReferenceMotion
from app.science.rotations import FloatArray, is_unit
from app.science.skeleton import JOINT_COUNT

GAP_S = 0.25
"""Longest gap between two frames; after a longer one, hinges restart, as the direction in which
they turned is unknown."""
_CHUNK_FRAMES = 1024
_LETTERS = ("X", "Y", "Z")


class HingeReference:
    """Converts a participant's poses to the target rotations of one avatar's hinges.

    Args:
        limits: axis name -> limits in force, of every axis of every present part.
        parts: names of the avatar's parts.

    Raises:
        TargetError: an axis has no limits.
    """

    def __init__(self, limits: Mapping[str, Limits], parts: Collection[str] = PART_NAMES) -> None:
        self._angles = TargetAngles(limits, parts)
        self._columns = np.full((len(ERROR_JOINTS_WITH_FINGERS), len(_LETTERS)), -1)
        for column, axis in enumerate(AXES):
            if axis.part in ERROR_JOINTS_WITH_FINGERS and axis.part in parts:
                joint = ERROR_JOINTS_WITH_FINGERS.index(axis.part)
                self._columns[joint, _LETTERS.index(axis.letter)] = column
        present = self._columns >= 0
        turning = self._angles.low_rad < self._angles.high_rad
        self._turns = present & turning[self._columns]
        self._hinged = np.asarray(present.any(axis=1))

    def recording(self, times_s: FloatArray, rotations: FloatArray) -> ReferenceMotion:
        """Return the target rotations of each frame of a recording.

        An invalid rotation makes the targets that depend on it unknown in its frame.

        Args:
            times_s: (N,) times of the frames, with any values. After a gap, or a time that does
                not increase, the hinges restart from rest.
            rotations: (N, 22, 4), or (N, 52, 4) with fingers: the participant's local rotations
                wxyz, as received.
        """
        target_rotations = np.empty(rotations.shape)
        columns = self._columns[: rotations.shape[1] - 1]
        if len(rotations) == 0:
            return ReferenceMotion(
                target_rotations, self._clipping(np.zeros((0, *columns.shape), np.bool_))
            )
        usable = _usable(rotations)
        body = usable[:, :JOINT_COUNT]
        fingers = usable[:, JOINT_COUNT:] if usable.shape[1] > JOINT_COUNT else None
        targets = self._angles.batch(body, fingers, restarts=_gaps(times_s))
        for first in range(0, len(rotations), _CHUNK_FRAMES):
            at = slice(first, first + _CHUNK_FRAMES)
            angles_rad = targets.unclamped_rad[at]
            target_rotations[at, :JOINT_COUNT] = joint_rotations(angles_rad, rotations[at, 0])
            if fingers is not None:
                target_rotations[at, JOINT_COUNT:] = finger_rotations(angles_rad)
        return ReferenceMotion(target_rotations, self._clipping(targets.clipped[:, columns]))

    def pose(self, rotations: FloatArray) -> FloatArray:
        """Return the target rotations of a single pose (22, 4), without previous frames.

        They are NaN for joints that have no hinge, and for joints that depend on an invalid
        rotation.
        """
        self._angles.forget()
        unclamped_rad = self._angles.follow(_usable(rotations)).unclamped_rad
        target_rotations = joint_rotations(unclamped_rad, rotations[0])
        target_rotations[1:][~self._hinged[: JOINT_COUNT - 1]] = np.nan
        return target_rotations

    def _clipping(self, clipped: npt.NDArray[np.bool_]) -> Clipping:
        joints = clipped.shape[1]
        return Clipping(clipped, self._turns[:joints], self._hinged[:joints])


def _usable(rotations: FloatArray) -> FloatArray:
    """Return the rotations with NaN in place of invalid ones."""
    return np.where(is_unit(rotations)[..., np.newaxis], rotations, np.nan)


def _gaps(times_s: FloatArray) -> npt.NDArray[np.bool_]:
    """Return whether there is a gap before each frame, (N,)."""
    with np.errstate(invalid="ignore"):
        step_s = np.diff(times_s, prepend=np.nan)
        return np.asarray(~((step_s > 0.0) & (step_s <= GAP_S)))
