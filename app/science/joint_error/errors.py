"""Compute joint errors: how far each joint of a body is from where it should be.

For the target's and the actual local rotation of a joint (both parent_from_joint) the error is the
rotation that leads from the target to the actual one, seen in the parent's frame:

    q_error = q_actual q_target^-1,   angle = |log q_error|,   (x, y, z) = log q_error,

the rotation vector of the shorter way round, in radians along the parent's axes. So +x means that
the joint has turned too far about its parent's x axis. The angle is the geodesic distance. The hips
have no delay and no parent, and are left out.

A sample counts only if both quaternions are finite and of unit length within 0.001; others are
flagged and counted, not repaired. This is the joint error of Karas (2020), sections 3 and 7.

The target is never clamped: a rotation that the limits of an avatar's hinges prevent is part of the
error. The share of samples in which a limit did so is given as well (`Clipping`), which
distinguishes a joint that could not follow from one that followed badly.

A pose has 22 rotations or, where fingers are recorded, 52: those of the body, then those of the
`FINGER_PARTS`. Below, J is the number of joints that have an error: 21, or 51 with fingers.
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
from app.science.skeleton import FINGER_COUNT, FINGER_PARTS, JOINT_COUNT, JOINT_NAMES

#: The joints that have an error, in order: all but the hips.
ERROR_JOINTS: tuple[str, ...] = JOINT_NAMES[1:]
#: The same of a body whose fingers are recorded, too.
ERROR_JOINTS_WITH_FINGERS: tuple[str, ...] = (*ERROR_JOINTS, *FINGER_PARTS)
#: What is summarised for each joint: the angle and the components of the rotation vector.
ERROR_AXES: tuple[str, ...] = ("angle", "x", "y", "z")
_P95 = 95.0
_POSES = ((JOINT_COUNT, 4), (JOINT_COUNT + FINGER_COUNT, 4))
_Bools = npt.NDArray[np.bool_]


class JointErrorError(ValueError):
    """The shapes of target, actual and clipping do not match."""


@dataclass(frozen=True, eq=False)
class JointErrors:
    """The joint errors of N frames, in radians.

    Attributes:
        values_rad: (N, J, 4) in the order of the joints and ERROR_AXES; zero where not valid.
        valid: (N, J) whether each sample counts.
    """

    values_rad: FloatArray
    valid: _Bools


@dataclass(frozen=True, eq=False)
class Clipping:
    """Marks where the limits of an avatar's hinges reduced the target rotation, for N frames.

    A hinge belongs to the axis along which it lies in the T-pose. Only the first hinge of a joint
    stays on the parent's axis in every pose; the others turn with it.

    Attributes:
        clipped: (N, J, 3) whether the hinge along x, y and z reached its limit.
        turns: (J, 3) whether there is such a hinge, and it is not locked.
        hinged: (J,) whether the joint has a hinge at all, locked or not. A joint without hinges
            has no target of its own, so it has no error.
    """

    clipped: _Bools
    turns: _Bools
    hinged: _Bools

    @property
    def by_axis(self) -> _Bools:
        """Whether each axis is clipped: (N, J, 4), in the order of ERROR_AXES.

        The angle counts as clipped where one of its axes is.
        """
        each = self.clipped & self.turns
        return np.concatenate((each.any(axis=2, keepdims=True), each), axis=2)

    @property
    def driven(self) -> _Bools:
        """Whether each joint and axis can be clipped: (J, 4), in the order of ERROR_AXES."""
        return np.concatenate((self.turns.any(axis=1, keepdims=True), self.turns), axis=1)


@dataclass(frozen=True, eq=False)
class JointErrorSummary:
    """The joint errors of a phase, per joint and axis, in radians.

    Values are NaN for a joint without a valid sample.

    Attributes:
        mean_rad: (J, 4) signed mean.
        rms_rad: (J, 4) root mean square.
        p95_rad: (J, 4) 95th percentile of the absolute value (linear interpolation).
        max_rad: (J, 4) largest absolute value.
        count: (J,) valid samples.
        left_out: (J,) samples that did not count.
        clipped_share: (J, 4) share of the valid samples in which a limit reduced the target; NaN
            without a hinge that turns, and everywhere for a body without limits.
    """

    axes: ClassVar[tuple[str, ...]] = ERROR_AXES

    mean_rad: FloatArray
    rms_rad: FloatArray
    p95_rad: FloatArray
    max_rad: FloatArray
    count: npt.NDArray[np.int64]
    left_out: npt.NDArray[np.int64]
    clipped_share: FloatArray

    @property
    def joints(self) -> tuple[str, ...]:
        """Return the names of the joints, in order."""
        return ERROR_JOINTS_WITH_FINGERS[: len(self.count)]


def joint_errors(target: FloatArray, actual: FloatArray) -> JointErrors:
    """Return the error of each joint in each frame.

    Args:
        target, actual: (N, 22, 4), or (N, 52, 4) with fingers: local rotations wxyz at the same
            times.

    Raises:
        JointErrorError: the shapes differ or are others.
    """
    if target.shape != actual.shape or target.ndim != 3 or target.shape[1:] not in _POSES:
        raise JointErrorError(
            f"Target {target.shape} and actual {actual.shape} do not fit: both must be (N, 22, 4),"
            " or (N, 52, 4) with fingers, frame for frame."
        )
    expected = np.asarray(target[:, 1:], dtype=np.float64)
    observed = np.asarray(actual[:, 1:], dtype=np.float64)
    valid = is_unit(expected) & is_unit(observed)
    if not valid.all():
        expected = np.where(valid[..., np.newaxis], expected, identity())
        observed = np.where(valid[..., np.newaxis], observed, identity())
    vector = to_rotation_vector(multiply(observed, conjugate(expected)))
    angle = np.sqrt(np.einsum("...i,...i->...", vector, vector))
    return JointErrors(np.concatenate((angle[..., np.newaxis], vector), axis=-1), valid)


def summarise_joint_errors(
    errors: JointErrors, clipping: Clipping | None = None
) -> JointErrorSummary:
    """Summarise a phase's errors per joint and axis.

    Args:
        errors: the errors of N frames.
        clipping: the clipping of the same frames; None for a body without limits.

    Raises:
        JointErrorError: the clipping has another number of frames.
    """
    joints, axes = errors.valid.shape[1], len(ERROR_AXES)
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
    shares = np.full((valid.shape[1], len(ERROR_AXES)), np.nan)
    if clipping is not None:
        clipped = clipping.by_axis
        for joint in np.flatnonzero(valid.any(axis=0)):
            shares[joint] = clipped[valid[:, joint], joint].mean(axis=0)
        shares[~clipping.driven] = np.nan
    return shares


def joint_error_summary(
    target: FloatArray, actual: FloatArray, clipping: Clipping | None = None
) -> JointErrorSummary:
    """Return the error summary of a target and an actual recording.

    See `joint_errors` for shapes and `summarise_joint_errors` for the clipping, and both for the
    errors raised.
    """
    return summarise_joint_errors(joint_errors(target, actual), clipping)
