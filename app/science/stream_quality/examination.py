"""Every frame of a span judged, fault by fault."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.science.skeleton import JOINT_COUNT
from app.science.stream_quality.faults import Pacing, changes, is_timed, jumps, pace, stillness
from app.science.stream_quality.limits import USUAL, QualityError, QualityLimits
from app.science.stream_quality.memory import LastPose, Memory

Bools = NDArray[np.bool_]
Floats = NDArray[np.floating[Any]]
NOTHING = Memory()


@dataclass(frozen=True)
class Examination:
    """What is wrong with each of n frames.

    `non_finite` and `non_unit` (n,) as on the wire: such a frame is left out of what follows.
    `turned` (n, 22) and `shifted` (n,): the joint, or the hips' place, jumped against the frame
    before. `frozen` (n, 22). `after` is for the span that follows.
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
        """Frames (n,) with a jump of any kind."""
        jumped: Bools = self.turned.any(axis=1) | self.shifted
        return jumped


def examine(
    times_s: NDArray[np.float64],
    rotations: Floats,
    positions_m: Floats,
    *,
    limits: QualityLimits = USUAL,
    usual_s: float | None = None,
    before: Memory = NOTHING,
) -> Examination:
    """Judge each frame of a span of one stream.

    Args:
        times_s: (n,) client monotonic time of each frame, in s.
        rotations: (n, 22, 4) local rotations wxyz, as they came.
        positions_m: (n, 3) place of the hips.
        limits: what counts as a fault.
        usual_s: interval that frames usually have; None takes the median of this span.
        before: what is known of the frames before; with the same `usual_s` the judgement does not
            depend on where a recording is cut into spans.

    Raises:
        QualityError: the shapes do not fit.
    """
    _require_shapes(times_s, rotations, positions_m)
    non_finite, non_unit = _broken(times_s, rotations, positions_m, limits)
    pacing = pace(times_s, limits, usual_s, before)
    timed = is_timed(times_s, limits)
    sound = np.flatnonzero(timed & ~(non_finite | non_unit))
    turned = np.zeros((len(times_s), JOINT_COUNT), np.bool_)
    frozen = np.zeros_like(turned)
    shifted = np.zeros(len(times_s), np.bool_)
    # One sum from the very first frame on, so that cutting a recording rounds nothing differently.
    watched_s = np.cumsum(np.concatenate(([before.watched_s], pacing.watched_s)))[1:]
    after = _paced(before, times_s[timed], watched_s)
    if len(sound):
        whole = len(sound) == len(times_s)
        usable = slice(None) if whole else sound
        poses = (times_s[usable], rotations[usable], positions_m[usable])
        turned[usable], shifted[usable] = _jumped(*poses, pacing.usual_s, limits, before)
        found = stillness(changes(poses[1], before), watched_s[usable], limits, before)
        frozen[usable] = found.frozen
        after = replace(
            after,
            pose=LastPose(
                time_s=float(times_s[sound[-1]]),
                watched_s=float(watched_s[sound[-1]]),
                rotations=poses[1][-1].copy(),
                position_m=poses[2][-1].copy(),
            ),
            changed_s=found.changed_s,
            lively_s=found.lively_s,
            frozen_s=found.frozen_s,
            frozen=found.frozen[-1],
        )
    return Examination(pacing, non_finite, non_unit, turned, shifted, frozen, after)


def _broken(
    times_s: NDArray[np.float64], rotations: Floats, positions_m: Floats, limits: QualityLimits
) -> tuple[Bools, Bools]:
    """Frames with a value that is not a number, and those with a rotation that is none."""
    with np.errstate(invalid="ignore", over="ignore"):
        wide = rotations.astype(np.float64)
        length = np.sqrt(np.einsum("njk,njk->nj", wide, wide))
        unit = (np.abs(length - 1.0) <= limits.unit_tolerance).all(axis=1)
    finite = np.isfinite(times_s) & np.isfinite(positions_m).all(axis=1)
    # A rotation of unit length holds numbers only.
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


def _paced(before: Memory, times_s: NDArray[np.float64], watched_s: NDArray[np.float64]) -> Memory:
    """What is known after the span if none of its poses is usable, from the times that are some."""
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
            f"Shapes {times_s.shape}, {rotations.shape} and {positions_m.shape} do not fit: times"
            f" (n,), rotations (n, {JOINT_COUNT}, 4) and places (n, 3) of the same frames are"
            " needed."
        )
