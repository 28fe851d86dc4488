"""What an avatar moved by physics is asked for: the pose its hinges would make without limits.

The participant's own rotations are not the measure of such an avatar. Its shoulders have no hinge,
its elbows and knees bend in one plane, and what these cannot do is given to their neighbours so
that hands, feet and head still point where the participant's do (`targets`). Against the raw
rotations an avatar that does exactly as it is told would be wrong in both neighbours, by the same
turn forth and back: at a shrug by 20 degrees in the shoulder and in the upper arm, while the arm is
where it should be. So errors of its joints are counted from the rotations that its hinges are asked
for, joint by joint, before their limits (`TargetAngles.unclamped_rad`).

What is left out of this reference:

- The limits. What they take away is error, and is counted in `Clipping` beside it. A hinge that is
  locked, such as a human elbow's third axis or a limb in a cast, is asked for what it cannot do
  either: that is error too. It is not counted as clipped, since it is not driven.
- In a configuration whose targets are meant in the world, the way in which head and arms give way
  when the trunk is pushed aside (`following`). It follows from what the avatar did, so it is no
  part of what it was asked for.
- Fingers, which have no error.

For a delayed copy nothing of this holds: it repeats the participant's rotations.
"""

from collections.abc import Collection, Mapping

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import AXES, PART_NAMES
from app.science.avatar.targets.targets import Limits, TargetAngles, joint_rotations
from app.science.joint_error import ERROR_JOINTS, Clipping, ReferenceMotion
from app.science.rotations import FloatArray, is_unit

GAP_S = 0.25
"""After a longer one the pose before says nothing about which way a hinge went since."""
_AT_ONCE = 1024
_LETTERS = ("X", "Y", "Z")


class HingeReference:
    """Turns a participant's poses into what the hinges of one avatar are asked for.

    Args:
        limits: axis name -> limits in force, of every axis of every present part.
        parts: names of the avatar's parts.

    Raises:
        TargetError: an axis has no limits.
    """

    def __init__(self, limits: Mapping[str, Limits], parts: Collection[str] = PART_NAMES) -> None:
        self._angles = TargetAngles(limits, parts)
        self._columns = np.full((len(ERROR_JOINTS), len(_LETTERS)), -1)
        for column, axis in enumerate(AXES):
            if axis.part in ERROR_JOINTS and axis.part in parts:
                joint = ERROR_JOINTS.index(axis.part)
                self._columns[joint, _LETTERS.index(axis.letter)] = column
        there = self._columns >= 0
        turning = self._angles.low_rad < self._angles.high_rad
        self._turns = there & turning[self._columns]
        self._hinged = np.asarray(there.any(axis=1))

    def recording(self, times_s: FloatArray, rotations: FloatArray) -> ReferenceMotion:
        """Return what was asked for in each frame of a recording.

        A rotation that is none makes unknown what follows from it, in its frame.

        Args:
            times_s: (N,) of the frames; may hold anything. After a gap, or a time that does not
                rise, the hinges are followed anew.
            rotations: (N, 22, 4) the participant's local rotations wxyz, as they came.
        """
        asked = np.empty(rotations.shape)
        if len(rotations) == 0:
            return ReferenceMotion(
                asked, self._clipping(np.zeros((0, *self._turns.shape), np.bool_))
            )
        found = self._angles.batch(_usable(rotations), anew=_gaps(times_s))
        for first in range(0, len(rotations), _AT_ONCE):
            at = slice(first, first + _AT_ONCE)
            asked[at] = joint_rotations(found.unclamped_rad[at], rotations[at, 0])
        return ReferenceMotion(asked, self._clipping(found.clipped[:, self._columns]))

    def pose(self, rotations: FloatArray) -> FloatArray:
        """Return what is asked for in one pose (22, 4) of which no other is known.

        NaN for joints that have no hinge, and for what follows from a rotation that is none.
        """
        self._angles.forget()
        wanted = self._angles.follow(_usable(rotations)).unclamped_rad
        asked = joint_rotations(wanted, rotations[0])
        asked[1:][~self._hinged] = np.nan
        return asked

    def _clipping(self, clipped: npt.NDArray[np.bool_]) -> Clipping:
        return Clipping(clipped, self._turns, self._hinged)


def _usable(rotations: FloatArray) -> FloatArray:
    """Rotations with NaN in place of those that are none."""
    return np.where(is_unit(rotations)[..., np.newaxis], rotations, np.nan)


def _gaps(times_s: FloatArray) -> npt.NDArray[np.bool_]:
    """(N,) frames before which there is a gap."""
    with np.errstate(invalid="ignore"):
        step_s = np.diff(times_s, prepend=np.nan)
        return np.asarray(~((step_s > 0.0) & (step_s <= GAP_S)))
