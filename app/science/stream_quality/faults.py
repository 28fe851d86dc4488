"""What can be wrong with a span of frames: joints that freeze, poses that jump, times that halt.

A frozen joint's rotation stays the same to the last bit while the body moves. A sensor that has
frozen looks like that. So does a joint that nobody tracks, or one that a solver lets rest between
two steps; but these were still before. Only a joint that was lively so far can freeze.

A jump is a pose that no body could take so quickly after the one before. The pace of the frames has
their intervals, gaps, and clocks that ran backwards.
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
    """How still each joint was: `frozen` (n, 22), and per joint (22,) what the next span needs."""

    frozen: Bools
    changed_s: Table
    lively_s: Table
    frozen_s: Table


def changes(rotations: NDArray[np.floating[Any]], before: Memory) -> Bools:
    """Which joints differ in any bit from the frame before: (n, 22) for rotations (n, 22, 4)."""
    bits = _bits(rotations)
    changed = np.zeros((len(rotations), JOINT_COUNT), np.bool_)
    for part in bits:  # quicker than `any` over an axis that short
        changed[1:] |= part[1:] != part[:-1]
    if before.pose is not None:
        last = before.pose.rotations.astype(rotations.dtype, copy=False)[np.newaxis]
        for part, last_part in zip(bits, _bits(last), strict=True):
            changed[0] |= part[0] != last_part[0]
    return changed


def _bits(rotations: NDArray[np.floating[Any]]) -> list[NDArray[np.uint64]]:
    """Quaternions as a few tables (n, 22) of whole numbers, quicker to compare than four floats."""
    whole = np.ascontiguousarray(rotations).view(np.uint64)
    return [whole[..., part] for part in range(whole.shape[-1])]


def stillness(changed: Bools, watched_s: Table, limits: QualityLimits, before: Memory) -> Stillness:
    """Which joints are frozen, from `changed` (n, 22) as told by `changes`.

    `watched_s` (n,) is the time of each frame with gaps left out, so that a joint is not blamed for
    what nobody saw.
    """
    last_s = before.watched_s if before.pose is None else before.pose.watched_s
    passed_s = np.diff(watched_s, prepend=last_s)
    at_s = np.where(changed, watched_s[:, np.newaxis], -np.inf)
    known_s = before.changed_s if before.pose is not None else watched_s[0]
    np.maximum(at_s[0], known_s, out=at_s[0])
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
    # How long a joint was frozen says nothing about how it moves, so it is left out; each turn
    # knows of one more time.
    while True:
        found = may_freeze & (lively_s >= limits.lively_share * (at_s - lost_s))
        if np.array_equal(found, frozen):
            return Stillness(frozen, at_s[-1], lively_s[-1], lost_s[-1])
        frozen = found
        lost_s = _lost_s(frozen, passed_s, limits, before)


def _lost_s(frozen: Bools, passed_s: Table, limits: QualityLimits, before: Memory) -> Table:
    """For how long each joint was frozen up to each frame (n, 22), noticing it included."""
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
    """Which frames jump against the one before: joints (n - 1, 22), and the hips' place (n - 1,).

    Times (n,), rotations (n, 22, 4) and places (n, 3) must be usable. Frames that are told to be
    closer together than usual are a stutter of the clock rather than of the body, so an interval
    counts as `usual_s` at least.
    """
    passed_s = np.fmax(times_s[1:] - times_s[:-1], usual_s)
    cosine = np.einsum("njk,njk->nj", rotations[1:], rotations[:-1])
    # Beyond half a turn every rotation is within reach.
    half_turn = np.minimum(0.5 * limits.turn_rad_per_s * passed_s, 0.5 * np.pi)
    turned = np.abs(cosine) < np.cos(half_turn)[:, np.newaxis]
    with np.errstate(over="ignore", invalid="ignore"):  # a place may be any number
        step_m = positions_m[1:] - positions_m[:-1]
        moved_m = np.sqrt(np.einsum("nk,nk->n", step_m, step_m))
        return turned, moved_m > limits.root_m_per_s * passed_s


@dataclass(frozen=True)
class Pacing:
    """Per frame (n,), against the frame before it that has a time.

    `interval_s` is NaN where there is none. `gap`: nothing came for too long before this frame.
    `backwards`: the frame is not later than the one before. `watched_s`: how much of the interval
    was covered by frames, 0 over a gap. `usual_s` is the interval frames usually have, NaN where
    that is unknown.
    """

    interval_s: NDArray[np.float64]
    gap: NDArray[np.bool_]
    backwards: NDArray[np.bool_]
    watched_s: NDArray[np.float64]
    usual_s: float


def is_timed(times_s: NDArray[np.float64], limits: QualityLimits) -> NDArray[np.bool_]:
    """Frames (n,) whose time can be one."""
    return np.asarray(np.abs(times_s) <= limits.latest_s)  # NaN is not


def pace(
    times_s: NDArray[np.float64], limits: QualityLimits, usual_s: float | None, before: Memory
) -> Pacing:
    """Judge times (n,); `usual_s` None takes the median interval of this span."""
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
