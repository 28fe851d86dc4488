"""How far a body is from where it should be, joint by joint.

For the target's and the actual local rotation of a joint (both parent_from_joint) the error is the
rotation that leads from the target to the actual one, seen in the parent's frame:

    q_error = q_actual q_target^-1,   angle = |log q_error|,   (x, y, z) = log q_error,

the rotation vector of the shorter way round, in radians along the parent's axes. So +x says that
the joint has turned too far about its parent's x axis. The angle is the geodesic distance. The hips
carry no delay and have no parent, and are left out.

A sample counts only if both quaternions are finite and of unit length within 0.001; others are
flagged and counted, not repaired. This is the joint error of Karas (2020), sections 3 and 7.

The target is never clamped: what the limits of an avatar's hinges take away is error. How often
they did stands beside it, as the share of the samples that count (`Clipping`), so that a joint that
could not follow is told from one that followed badly.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from app.science.rotations import (
    FloatArray,
    conjugate,
    identity,
    is_unit,
    multiply,
    to_rotation_vector,
)
from app.science.skeleton import JOINT_COUNT, JOINT_NAMES

#: The joints that have an error, in order: all but the hips.
ERROR_JOINTS: tuple[str, ...] = JOINT_NAMES[1:]
#: What is summarised for each joint: the angle and the rotation vector's parts.
ERROR_AXES: tuple[str, ...] = ("angle", "x", "y", "z")
_P95 = 95.0
_Bools = npt.NDArray[np.bool_]


class JointErrorError(ValueError):
    """Target and actual rotations do not belong together."""


@dataclass(frozen=True, eq=False)
class JointErrors:
    """Errors of N frames; radians.

    Attributes:
        values_rad: (N, 21, 4) in the order of ERROR_JOINTS and ERROR_AXES; zero where not valid.
        valid: (N, 21) which samples count.
    """

    values_rad: FloatArray
    valid: _Bools


@dataclass(frozen=True, eq=False)
class Clipping:
    """Where the limits of an avatar's hinges took something from the target; N frames.

    A hinge counts for the axis it lies along in the T-pose. Only the first hinge of a joint keeps
    to the parent's axis in every pose; the others are carried by it.

    Attributes:
        clipped: (N, 21, 3) of the hinge along x, y and z.
        turns: (21, 3) whether there is such a hinge, and it is not locked.
        hinged: (21,) whether the joint has a hinge at all, locked or not. One that has none is not
            asked for anything, so it has no error.
    """

    clipped: _Bools
    turns: _Bools
    hinged: _Bools

    @property
    def by_axis(self) -> _Bools:
        """(N, 21, 4) in the order of ERROR_AXES; the angle is clipped where one of its axes is."""
        each = self.clipped & self.turns
        return np.concatenate((each.any(axis=2, keepdims=True), each), axis=2)

    @property
    def driven(self) -> _Bools:
        """(21, 4) where there can be a share, in the order of ERROR_AXES."""
        return np.concatenate((self.turns.any(axis=1, keepdims=True), self.turns), axis=1)


@dataclass(frozen=True, eq=False)
class JointErrorSummary:
    """Errors of a phase, per joint and axis; radians; NaN for a joint without a valid sample.

    Attributes:
        mean_rad: (21, 4) signed mean.
        rms_rad: (21, 4) root of the mean square.
        p95_rad: (21, 4) 95th percentile of the absolute value (linear interpolation).
        max_rad: (21, 4) largest absolute value.
        count: (21,) valid samples.
        left_out: (21,) samples that did not count.
        clipped_share: (21, 4) share of the valid samples in which a limit took something from the
            target; NaN without a hinge that turns, and everywhere for a body without limits.
    """

    joints: ClassVar[tuple[str, ...]] = ERROR_JOINTS
    axes: ClassVar[tuple[str, ...]] = ERROR_AXES

    mean_rad: FloatArray
    rms_rad: FloatArray
    p95_rad: FloatArray
    max_rad: FloatArray
    count: npt.NDArray[np.int64]
    left_out: npt.NDArray[np.int64]
    clipped_share: FloatArray


def joint_errors(target: FloatArray, actual: FloatArray) -> JointErrors:
    """Return the error of each joint in each frame.

    Args:
        target, actual: (N, 22, 4) local rotations wxyz at the same times.

    Raises:
        JointErrorError: the shapes differ or are not (N, 22, 4).
    """
    if target.shape != actual.shape or target.ndim != 3 or target.shape[1:] != (JOINT_COUNT, 4):
        raise JointErrorError(
            f"Target {target.shape} and actual {actual.shape} do not fit: both must be (N, 22, 4),"
            " frame for frame."
        )
    goal = np.asarray(target[:, 1:], dtype=np.float64)
    got = np.asarray(actual[:, 1:], dtype=np.float64)
    valid = is_unit(goal) & is_unit(got)
    if not valid.all():
        goal = np.where(valid[..., np.newaxis], goal, identity())
        got = np.where(valid[..., np.newaxis], got, identity())
    vector = to_rotation_vector(multiply(got, conjugate(goal)))
    angle = np.sqrt(np.einsum("...i,...i->...", vector, vector))
    return JointErrors(np.concatenate((angle[..., np.newaxis], vector), axis=-1), valid)


def summarise_joint_errors(
    errors: JointErrors, clipping: Clipping | None = None
) -> JointErrorSummary:
    """Summarise a phase's errors per joint and axis.

    Args:
        errors: of N frames.
        clipping: of the same frames; left out for a body without limits.

    Raises:
        JointErrorError: the clipping is of another number of frames.
    """
    joints, axes = len(ERROR_JOINTS), len(ERROR_AXES)
    rows = np.full((4, joints, axes), np.nan)
    valid, frames = errors.valid, errors.valid.shape[0]
    left_out = frames - valid.sum(axis=0, dtype=np.int64)
    if clipping is not None:
        if clipping.clipped.shape[0] != frames:
            raise JointErrorError(
                f"{clipping.clipped.shape[0]} frames of clipping do not fit {frames} of errors."
            )
        valid = valid & clipping.hinged
        left_out[~clipping.hinged] = 0
    for joint in range(joints):
        values = errors.values_rad[valid[:, joint], joint]
        if values.shape[0] == 0:
            continue
        size = np.abs(values)
        rows[0, joint] = values.mean(axis=0)
        rows[1, joint] = np.sqrt(np.mean(values**2, axis=0))
        rows[2, joint] = np.percentile(size, _P95, axis=0)
        rows[3, joint] = size.max(axis=0)
    count = valid.sum(axis=0, dtype=np.int64)
    shares = _clipped_shares(valid, clipping)
    return JointErrorSummary(rows[0], rows[1], rows[2], rows[3], count, left_out, shares)


def _clipped_shares(valid: _Bools, clipping: Clipping | None) -> FloatArray:
    shares = np.full((len(ERROR_JOINTS), len(ERROR_AXES)), np.nan)
    if clipping is not None:
        clipped = clipping.by_axis
        for joint in np.flatnonzero(valid.any(axis=0)):
            shares[joint] = clipped[valid[:, joint], joint].mean(axis=0)
        shares[~clipping.driven] = np.nan
    return shares


def joint_error_summary(
    target: FloatArray, actual: FloatArray, clipping: Clipping | None = None
) -> JointErrorSummary:
    """Return the summary of two recordings.

    See `joint_errors` for shapes and `summarise_joint_errors` for the clipping, and both for the
    errors raised.
    """
    return summarise_joint_errors(joint_errors(target, actual), clipping)
