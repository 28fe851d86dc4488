"""The joint error of a recording, against the avatar's present reference and its delayed one.

A recording has two streams on one clock: the reference, which is the pose that the avatar should
reach at each of the participant's frames, and the pose that it had. They are compared twice:

- `present`: with the reference at the same moment. This is how much of the latency the participant
  sees.
- `command`: with the reference one delay earlier, by slerp between the two frames around that
  time; before the first frame, the first. This is how well the avatar follows its command.

The reference depends on how the avatar is moved. For a delayed copy it is the participant's own
rotations. For a physics avatar it is what its hinges can reproduce of them, before any limit
(`avatar.targets.hinge_reference`). Then the frames in which limits reduced the target are known
too, and this clipping is shifted in time together with the reference.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.science.delay import delayed_pose
from app.science.joint_error.errors import (
    ERROR_AXES,
    Clipping,
    JointErrorError,
    JointErrors,
    JointErrorSummary,
    joint_errors,
    summarise_joint_errors,
)
from app.science.rotations import FloatArray

Indices = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class ReferenceMotion:
    """The reference of an avatar: the pose that it should reach, in each of N frames.

    Attributes:
        rotations: (N, 22, 4) or (N, 52, 4) local rotations wxyz, unclamped; not finite where they
            are unknown.
        clipping: the clipping of the same frames; None for an avatar without limits.
    """

    rotations: FloatArray
    clipping: Clipping | None = None

    def at(self, frames: Indices) -> "ReferenceMotion":
        """Return the reference in the given frames, in their order."""
        return ReferenceMotion(self.rotations[frames], _clipped_at(self.clipping, frames))


@dataclass(frozen=True, eq=False)
class Recorded:
    """One run of a recording, with the participant's and the avatar's frames on one clock.

    Attributes:
        times_s: (N,) times of the participant's frames, s; any values are allowed.
        reference: the reference of the same N frames.
        partners: (M,) for each frame of the avatar, the index of the corresponding frame of the
            participant.
        actual_times_s: (M,) times of the avatar's frames, s; only those that count.
        actual: (M, 22, 4) or (M, 52, 4) the avatar's local rotations; as many as the reference has.
    """

    times_s: FloatArray
    reference: ReferenceMotion
    partners: Indices
    actual_times_s: FloatArray
    actual: FloatArray


@dataclass(frozen=True, eq=False)
class RecordedErrors:
    """The errors against both references, summarised and frame by frame.

    Attributes:
        present, command: summaries of the errors against the present and the delayed reference.
        present_rad, command_rad: (N, J) angle of each joint in all frames of the avatar, run after
            run; NaN where a sample does not count.
    """

    present: JointErrorSummary
    command: JointErrorSummary
    present_rad: FloatArray
    command_rad: FloatArray


def recorded_errors(runs: Sequence[Recorded], delay_s: float) -> RecordedErrors:
    """Summarise the joint errors of several runs of the same avatar together.

    Raises:
        JointErrorError: there is no run, or its shapes do not fit.
        DelayError: the delay is below zero or not finite.
    """
    if not runs:
        raise JointErrorError("A recording without runs has no errors: give at least one.")
    present, present_rad = _together([run.reference.at(run.partners) for run in runs], runs)
    command, command_rad = _together([_commanded(run, delay_s) for run in runs], runs)
    return RecordedErrors(present, command, present_rad, command_rad)


def _together(
    references: Sequence[ReferenceMotion], runs: Sequence[Recorded]
) -> tuple[JointErrorSummary, FloatArray]:
    """Return the summary of all runs and the angles that it counts."""
    clippings = [part.clipping for part in references if part.clipping is not None]
    clipping = clippings[0] if clippings else None
    if clipping is not None:
        clipped = np.concatenate([part.clipped for part in clippings])
        clipping = Clipping(clipped, clipping.turns, clipping.hinged)
    errors = joint_errors(
        np.concatenate([part.rotations for part in references]),
        np.concatenate([run.actual for run in runs]),
    )
    return summarise_joint_errors(errors, clipping), _counted_angles(errors, clipping)


def _counted_angles(errors: JointErrors, clipping: Clipping | None) -> FloatArray:
    """Return the angles (N, J); NaN where the summary does not count the sample."""
    counts = errors.valid if clipping is None else errors.valid & clipping.hinged
    return np.where(counts, errors.values_rad[..., ERROR_AXES.index("angle")], np.nan)


def _commanded(run: Recorded, delay_s: float) -> ReferenceMotion:
    """Return the reference one delay before each of the avatar's frames; NaN where unknown."""
    query_s = run.actual_times_s
    rotations = np.full((len(query_s), *run.reference.rotations.shape[1:]), np.nan)
    nearest = np.zeros(len(query_s), np.int64)
    rising = np.flatnonzero(_rising(run.times_s))
    finite = np.isfinite(query_s)
    if len(rising) and finite.any():
        times_s, reference = run.times_s[rising], run.reference.rotations[rising]
        rotations[finite] = delayed_pose(times_s, reference, query_s[finite], delay_s)
        nearest[finite] = rising[_nearest(times_s, query_s[finite] - delay_s)]
    # Between two frames, the clipping of the nearer one applies.
    return ReferenceMotion(rotations, _clipped_at(run.reference.clipping, nearest))


def _clipped_at(clipping: Clipping | None, frames: Indices) -> Clipping | None:
    if clipping is None:
        return None
    return Clipping(clipping.clipped[frames], clipping.turns, clipping.hinged)


def _nearest(times_s: FloatArray, query_s: FloatArray) -> Indices:
    """Return the index of the nearest of the increasing times for each query."""
    middles_s = (times_s[1:] + times_s[:-1]) / 2.0
    return np.asarray(np.searchsorted(middles_s, query_s), dtype=np.int64)


def _rising(times_s: FloatArray) -> npt.NDArray[np.bool_]:
    """Return a mask of the samples whose time is finite and later than all previous ones."""
    usable = np.where(np.isfinite(times_s), times_s, -np.inf)
    before = np.concatenate(([-np.inf], np.maximum.accumulate(usable)[:-1]))
    return np.asarray(usable > before)
