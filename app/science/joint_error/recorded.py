"""The joint error of a recording, against what the avatar was asked for now and a moment ago.

A recording has two streams on one clock: what the avatar was asked for at each frame of the
participant, and what it did. It is compared twice:

- `present`: with what was asked for at that moment. This is what the participant sees of the
  latency.
- `command`: with what was asked for one delay earlier, by slerp between the two frames around that
  time; before the first frame, the first. This is how well the avatar does what it is told.

What an avatar is asked for depends on how it is moved. A delayed copy is asked for the
participant's own rotations. One that is moved by physics is asked for what its hinges can make of
them, before any limit (`avatar.hinge_reference`); where limits took something away is then known
too, and belongs to the same time as what it is compared with.
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
from app.science.skeleton import JOINT_COUNT

Indices = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Asked:
    """What an avatar was asked for in N frames.

    Attributes:
        rotations: (N, 22, 4) local rotations wxyz, unclamped; not finite where nothing can be said.
        clipping: of the same frames; None for an avatar without limits.
    """

    rotations: FloatArray
    clipping: Clipping | None = None

    def at(self, frames: Indices) -> "Asked":
        """The same in other frames: all that are named, in their order."""
        return Asked(self.rotations[frames], _clipped_at(self.clipping, frames))


@dataclass(frozen=True, eq=False)
class Recorded:
    """One run of both streams; times in s on one clock.

    Attributes:
        times_s: (N,) of the participant's frames; may hold anything.
        asked: N frames.
        partners: (M,) which of the N frames each frame of the avatar is of.
        actual_times_s: (M,) of the avatar's frames; only those that count.
        actual: (M, 22, 4) its local rotations.
    """

    times_s: FloatArray
    asked: Asked
    partners: Indices
    actual_times_s: FloatArray
    actual: FloatArray


@dataclass(frozen=True, eq=False)
class RecordedErrors:
    """Both comparisons, summed up and frame by frame.

    Attributes:
        present_rad, command_rad: (N, 21) whole angle of each joint in all frames of the avatar, run
            after run; NaN where a sample does not count.
    """

    present: JointErrorSummary
    command: JointErrorSummary
    present_rad: FloatArray
    command_rad: FloatArray


def recorded_errors(runs: Sequence[Recorded], delay_s: float) -> RecordedErrors:
    """Summarise the runs of the same avatar together.

    Raises:
        JointErrorError: there is no run, or its shapes do not fit. DelayError: the delay is below
            zero or not finite.
    """
    if not runs:
        raise JointErrorError("A recording without runs has no errors: give at least one.")
    present, present_rad = _together([run.asked.at(run.partners) for run in runs], runs)
    command, command_rad = _together([_commanded(run, delay_s) for run in runs], runs)
    return RecordedErrors(present, command, present_rad, command_rad)


def _together(
    asked: Sequence[Asked], runs: Sequence[Recorded]
) -> tuple[JointErrorSummary, FloatArray]:
    """The summary, and the angles that it counts."""
    clippings = [one.clipping for one in asked if one.clipping is not None]
    clipping = clippings[0] if clippings else None
    if clipping is not None:
        every = np.concatenate([one.clipped for one in clippings])
        clipping = Clipping(every, clipping.turns, clipping.hinged)
    errors = joint_errors(
        np.concatenate([one.rotations for one in asked]),
        np.concatenate([run.actual for run in runs]),
    )
    return summarise_joint_errors(errors, clipping), _counted_angles(errors, clipping)


def _counted_angles(errors: JointErrors, clipping: Clipping | None) -> FloatArray:
    """(N, 21) as the summary counts: a joint without a hinge is asked for nothing."""
    counts = errors.valid if clipping is None else errors.valid & clipping.hinged
    return np.where(counts, errors.values_rad[..., ERROR_AXES.index("angle")], np.nan)


def _commanded(run: Recorded, delay_s: float) -> Asked:
    """What was asked for one delay before each of the avatar's frames; NaN where it is unknown."""
    query_s = run.actual_times_s
    rotations = np.full((len(query_s), JOINT_COUNT, 4), np.nan)
    nearest = np.zeros(len(query_s), np.int64)
    rising = np.flatnonzero(_rising(run.times_s))
    known = np.isfinite(query_s)
    if len(rising) and known.any():
        times_s, asked = run.times_s[rising], run.asked.rotations[rising]
        rotations[known] = delayed_pose(times_s, asked, query_s[known], delay_s)
        nearest[known] = rising[_nearest(times_s, query_s[known] - delay_s)]
    # A clipping between two frames is that of the nearer one.
    return Asked(rotations, _clipped_at(run.asked.clipping, nearest))


def _clipped_at(clipping: Clipping | None, frames: Indices) -> Clipping | None:
    if clipping is None:
        return None
    return Clipping(clipping.clipped[frames], clipping.turns, clipping.hinged)


def _nearest(times_s: FloatArray, query_s: FloatArray) -> Indices:
    """Which of the rising times is nearest to each query."""
    middles_s = (times_s[1:] + times_s[:-1]) / 2.0
    return np.asarray(np.searchsorted(middles_s, query_s), dtype=np.int64)


def _rising(times_s: FloatArray) -> npt.NDArray[np.bool_]:
    """The samples whose time is finite and later than all before."""
    usable = np.where(np.isfinite(times_s), times_s, -np.inf)
    before = np.concatenate(([-np.inf], np.maximum.accumulate(usable)[:-1]))
    return np.asarray(usable > before)
