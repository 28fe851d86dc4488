"""Checks of a span of frames for frozen joints, jumping poses, and gaps or reversals of time.

The rotation of a frozen joint stays the same to the last bit while the body moves, as with a sensor
that has frozen. An untracked joint, or one that a solver keeps at rest between two steps, looks the
same; but these had been still before. Only a joint that was lively until then can freeze.

A jump is a pose that no body could reach so soon after the previous one. The pacing of the frames
covers their intervals, gaps, and clocks that ran backwards.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.science.skeleton import JOINT_COUNT
from app.science.stream_quality.limits import QualityLimits
from app.science.stream_quality.memory import Memory

Bools = NDArray[np.bool_]
Table = NDArray[np.float64]


@dataclass(frozen=True)
class Stillness:
    """The joints that were frozen in each frame (`frozen`, n x 22), and the state to carry over.

    `changed_s`, `lively_s` and `frozen_s` (22,) are those of `Memory` after the span.
    """

    frozen: Bools
    changed_s: Table
    lively_s: Table
    frozen_s: Table


def changes(rotations: NDArray[np.floating[Any]], before: Memory) -> Bools:
    """Return which joints differ in any bit from the previous frame, (n, 22).

    `rotations` is (n, 22, 4).
    """
    bits = _bits(rotations)
    changed = np.zeros((len(rotations), JOINT_COUNT), np.bool_)
    for part in bits:  # faster than `any` over such a short axis
        changed[1:] |= part[1:] != part[:-1]
    if before.pose is not None:
        last = before.pose.rotations.astype(rotations.dtype, copy=False)[np.newaxis]
        for part, last_part in zip(bits, _bits(last), strict=True):
            changed[0] |= part[0] != last_part[0]
    return changed


def _bits(rotations: NDArray[np.floating[Any]]) -> list[NDArray[np.uint64]]:
    """Return quaternions as tables (n, 22) of integers, which compare faster than four floats."""
    whole = np.ascontiguousarray(rotations).view(np.uint64)
    return [whole[..., part] for part in range(whole.shape[-1])]


def stillness(changed: Bools, watched_s: Table, limits: QualityLimits, before: Memory) -> Stillness:
    """Return which joints are frozen, from `changed` (n, 22) as returned by `changes`.

    `watched_s` (n,) is the time of each frame with gaps left out, so that a joint does not count as
    still while no frames arrived.
    """
    last_s = before.watched_s if before.pose is None else before.pose.watched_s
    passed_s = np.diff(watched_s, prepend=last_s)
    at_s = np.where(changed, watched_s[:, np.newaxis], -np.inf)
    changed_before_s = before.changed_s if before.pose is not None else watched_s[0]
    np.maximum(at_s[0], changed_before_s, out=at_s[0])
    np.maximum.accumulate(at_s, axis=0, out=at_s)
    still_s = watched_s[:, np.newaxis] - at_s
    lively_s = passed_s[:, np.newaxis] * (still_s < limits.lively_s)
    lively_s[0] += before.lively_s
    np.cumsum(lively_s, axis=0, out=lively_s)
    still = still_s >= limits.frozen_s
    if not still.any():
        return Stillness(still, at_s[-1], lively_s[-1], before.frozen_s)
    may_freeze = still & (lively_s >= limits.known_s)
    may_freeze &= (JOINT_COUNT - still.sum(axis=1) >= limits.others)[:, np.newaxis]
    may_freeze[:, list(limits.may_rest)] = False
    frozen, lost_s = np.zeros_like(still), before.frozen_s + np.zeros_like(at_s)
    # The time a joint was frozen is no evidence of how it moves, so it is left out of the lively
    # share.
    # Each iteration leaves out one more such time.
    while True:
        newly_found = may_freeze & (lively_s >= limits.lively_share * (at_s - lost_s))
        if np.array_equal(newly_found, frozen):
            return Stillness(frozen, at_s[-1], lively_s[-1], lost_s[-1])
        frozen = newly_found
        lost_s = _lost_s(frozen, passed_s, limits, before)


def _lost_s(frozen: Bools, passed_s: Table, limits: QualityLimits, before: Memory) -> Table:
    """Return how long each joint was frozen up to each frame, (n, 22) in s.

    The time until it was detected is included.
    """
    noticed = frozen & ~np.concatenate((before.frozen[np.newaxis], frozen[:-1]))
    lost_s = passed_s[:, np.newaxis] * frozen + limits.frozen_s * noticed
    lost_s[0] += before.frozen_s
    return np.cumsum(lost_s, axis=0)


Floats = NDArray[np.floating[Any]]


def jumps(
    times_s: NDArray[np.float64],
    rotations: Floats,
    positions_m: Floats,
    usual_s: float,
    limits: QualityLimits,
) -> tuple[Bools, Bools]:
    """Return which joints (n - 1, 22) and hip positions (n - 1,) jumped since the previous frame.

    Times (n,), rotations (n, 22, 4) and positions (n, 3) must be valid. Frames whose timestamps are
    closer together than usual indicate jitter of the clock rather than of the body, so an interval
    counts as at least `usual_s`.
    """
    passed_s = np.fmax(times_s[1:] - times_s[:-1], usual_s)
    cosine = np.einsum("njk,njk->nj", rotations[1:], rotations[:-1])
    # No two rotations are more than half a turn apart.
    half_turn = np.minimum(0.5 * limits.turn_rad_per_s * passed_s, 0.5 * np.pi)
    turned = np.abs(cosine) < np.cos(half_turn)[:, np.newaxis]
    with np.errstate(over="ignore", invalid="ignore"):  # a position may be any number
        step_m = positions_m[1:] - positions_m[:-1]
        moved_m = np.sqrt(np.einsum("nk,nk->n", step_m, step_m))
        return turned, moved_m > limits.root_m_per_s * passed_s


@dataclass(frozen=True)
class Pacing:
    """The timing of each frame (n,), relative to the previous frame with a valid time.

    `interval_s` is NaN where there is no such frame. `gap`: no frame arrived for too long before
    this one. `backwards`: the frame is not later than the previous one. `watched_s`: the part of
    the interval that was covered by frames, 0 over a gap. `usual_s` is the typical interval between
    frames, NaN where unknown.
    """

    interval_s: NDArray[np.float64]
    gap: NDArray[np.bool_]
    backwards: NDArray[np.bool_]
    watched_s: NDArray[np.float64]
    usual_s: float


def is_timed(times_s: NDArray[np.float64], limits: QualityLimits) -> NDArray[np.bool_]:
    """Return which frames have a valid time, (n,)."""
    return np.asarray(np.abs(times_s) <= limits.latest_s)  # False for NaN


def pace(
    times_s: NDArray[np.float64], limits: QualityLimits, usual_s: float | None, before: Memory
) -> Pacing:
    """Determine the pacing of a span from the times (n,) of its frames.

    If `usual_s` is None, the span's median interval is used.
    """
    interval_s = np.full(len(times_s), np.nan)
    timed = is_timed(times_s, limits)
    first = np.nan if before.time_s is None else before.time_s
    interval_s[timed] = np.diff(times_s[timed], prepend=first)
    forward = interval_s > 0.0
    if usual_s is None:
        usual_s = float(np.median(interval_s[forward])) if forward.any() else np.nan
    longest_s = np.fmax(limits.gap_frames * usual_s, limits.gap_s)
    gap = interval_s > longest_s
    return Pacing(
        interval_s=interval_s,
        gap=gap,
        backwards=interval_s <= 0.0,
        watched_s=np.where(forward & ~gap, interval_s, 0.0),
        usual_s=usual_s,
    )
