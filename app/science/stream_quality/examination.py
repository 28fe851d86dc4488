"""Examine every frame of a span for each kind of fault."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.science.skeleton import JOINT_COUNT
from app.science.stream_quality.faults import Pacing, changes, is_timed, jumps, pace, stillness
from app.science.stream_quality.limits import DEFAULT_LIMITS, QualityError, QualityLimits
from app.science.stream_quality.memory import LastPose, Memory

Bools = NDArray[np.bool_]
Floats = NDArray[np.floating[Any]]
EMPTY_MEMORY = Memory()


@dataclass(frozen=True)
class Examination:
    """The faults of each of n frames.

    `non_finite` and `non_unit` (n,) mark frames whose values are invalid as received; these frames
    are left out of all other checks. `turned` (n, 22) and `shifted` (n,) mark joints, and positions
    of the hips, that jumped since the previous frame. `frozen` (n, 22) marks frozen joints. `after`
    is the memory for the next span.
    """

    pacing: Pacing
    non_finite: Bools
    non_unit: Bools
    turned: Bools
    shifted: Bools
    frozen: Bools
    after: Memory

    @property
    def jumped(self) -> Bools:
        """Mask (n,) of the frames in which a joint or the hips jumped."""
        jumped: Bools = self.turned.any(axis=1) | self.shifted
        return jumped


def examine(
    times_s: NDArray[np.float64],
    rotations: Floats,
    positions_m: Floats,
    *,
    limits: QualityLimits = DEFAULT_LIMITS,
    usual_s: float | None = None,
    before: Memory = EMPTY_MEMORY,
) -> Examination:
    """Examine each frame of a span of one stream for faults.

    Args:
        times_s: (n,) client monotonic time of each frame, in s.
        rotations: (n, 22, 4) local rotations wxyz, as received.
        positions_m: (n, 3) position of the hips.
        limits: the limits beyond which something counts as a fault.
        usual_s: typical interval between frames; None uses the median of this span.
        before: memory of the previous spans; with the same `usual_s` the result does not depend on
            where a recording is cut into spans.

    Raises:
        QualityError: the shapes of the arrays do not match.
    """
    _require_shapes(times_s, rotations, positions_m)
    non_finite, non_unit = _invalid_values(times_s, rotations, positions_m, limits)
    pacing = pace(times_s, limits, usual_s, before)
    timed = is_timed(times_s, limits)
    valid = np.flatnonzero(timed & ~(non_finite | non_unit))
    turned = np.zeros((len(times_s), JOINT_COUNT), np.bool_)
    frozen = np.zeros_like(turned)
    shifted = np.zeros(len(times_s), np.bool_)
    # A running sum from the very first frame, so that rounding does not depend on where spans are
    # cut.
    watched_s = np.cumsum(np.concatenate(([before.watched_s], pacing.watched_s)))[1:]
    after = _memory_of_times(before, times_s[timed], watched_s)
    if len(valid):
        whole = len(valid) == len(times_s)
        usable = slice(None) if whole else valid
        poses = (times_s[usable], rotations[usable], positions_m[usable])
        turned[usable], shifted[usable] = _jumped(*poses, pacing.usual_s, limits, before)
        joints = stillness(changes(poses[1], before), watched_s[usable], limits, before)
        frozen[usable] = joints.frozen
        after = replace(
            after,
            pose=LastPose(
                time_s=float(times_s[valid[-1]]),
                watched_s=float(watched_s[valid[-1]]),
                rotations=poses[1][-1].copy(),
                position_m=poses[2][-1].copy(),
            ),
            changed_s=joints.changed_s,
            lively_s=joints.lively_s,
            frozen_s=joints.frozen_s,
            frozen=joints.frozen[-1],
        )
    return Examination(pacing, non_finite, non_unit, turned, shifted, frozen, after)


def _invalid_values(
    times_s: NDArray[np.float64], rotations: Floats, positions_m: Floats, limits: QualityLimits
) -> tuple[Bools, Bools]:
    """Return which frames have a non-finite value and which a non-unit quaternion, each (n,).

    A position that no room has counts as no number.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        wide = rotations.astype(np.float64)
        length = np.sqrt(np.einsum("njk,njk->nj", wide, wide))
        unit = (np.abs(length - 1.0) <= limits.unit_tolerance).all(axis=1)
    # NaN compares false, and infinity is beyond any room.
    finite = np.isfinite(times_s) & (np.abs(positions_m) <= limits.farthest_m).all(axis=1)
    # A quaternion of unit length contains finite numbers only.
    finite &= unit | np.isfinite(rotations).all(axis=(1, 2))
    return ~finite, finite & ~unit


def _jumped(
    times_s: NDArray[np.float64],
    rotations: Floats,
    positions_m: Floats,
    usual_s: float,
    limits: QualityLimits,
    before: Memory,
) -> tuple[Bools, Bools]:
    turned = np.zeros((len(times_s), JOINT_COUNT), np.bool_)
    shifted = np.zeros(len(times_s), np.bool_)
    if before.pose is None:
        turned[1:], shifted[1:] = jumps(times_s, rotations, positions_m, usual_s, limits)
        return turned, shifted
    last = before.pose
    return jumps(
        np.concatenate(([last.time_s], times_s)),
        np.concatenate((last.rotations[np.newaxis], rotations)),
        np.concatenate((last.position_m[np.newaxis], positions_m)),
        usual_s,
        limits,
    )


def _memory_of_times(
    before: Memory, times_s: NDArray[np.float64], watched_s: NDArray[np.float64]
) -> Memory:
    """Return the memory after a span without valid poses, updated from its valid times."""
    return replace(
        before,
        time_s=float(times_s[-1]) if len(times_s) else before.time_s,
        watched_s=float(watched_s[-1]) if len(watched_s) else before.watched_s,
    )


def _require_shapes(times_s: NDArray[np.float64], rotations: Floats, positions_m: Floats) -> None:
    n = len(times_s)
    if (
        times_s.shape != (n,)
        or rotations.shape != (n, JOINT_COUNT, 4)
        or positions_m.shape != (n, 3)
    ):
        raise QualityError(
            f"Shapes {times_s.shape}, {rotations.shape} and {positions_m.shape} do not match: times"
            f" (n,), rotations (n, {JOINT_COUNT}, 4) and positions (n, 3) of the same frames are"
            " needed."
        )
