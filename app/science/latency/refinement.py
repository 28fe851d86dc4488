"""Fine search: the lag at which the two bodies' rotations differ least, by Gauss-Newton.

At the lag tau the actual rotation q_a(t) of a joint is compared with the target's q_t(t - tau).
Both are smooth curves (see `smoothing`), as vectors of four on the same hemisphere, for which
|q_a - q_t| = 2 sin(angle / 4). A small change of the lag changes the difference along the rate u:

    r = q_a(t) - q_t(t - tau) ~ -delta u,    delta = - sum w r.u / sum w u_a.u_t,

with u the mean of both bodies' rates u_a and u_t. The rates' noise is independent between the
bodies, so the denominator is not inflated by it. From r and the rates the mean of each joint in
each block is taken off first: a limb that hangs too low for two seconds says nothing about time.
The weights w are one over the joint's variance, less where one difference sticks out (Huber).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.science.latency.smoothing import Curves, smoothed
from app.science.latency.stretches import Stretch
from app.science.rotations import FloatArray

# A tenth of a degree, as a chord: no tracker is better from frame to frame.
_LEAST_SCALE = float(np.radians(0.1)) / 2.0
_HUBER_SCALES = 2.5
_MOST_STEPS = 8
_LARGEST_STEP_S = 0.05
_SMALL_STEP_S = 1e-6


@dataclass(frozen=True, eq=False)
class Comparison:
    """A stretch with its actual body made smooth once, for all lags.

    `actual` are its curves at the stretch's active times (k,), `starts` (blocks,) where in them
    each block begins, `block` (k,) the block of each.
    """

    stretch: Stretch
    bandwidth_s: float
    actual: Curves
    starts: npt.NDArray[np.intp]
    block: npt.NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Fit:
    """Where a search ended.

    Attributes:
        lag_s: the lag, s.
        scale: (joints,) usual size of a difference, as a chord.
        top, bottom: (blocks,) each block's part of the two sums of delta at that lag.
    """

    lag_s: float
    scale: FloatArray
    top: FloatArray
    bottom: FloatArray


@dataclass(frozen=True, eq=False)
class _Differences:
    """At one lag: r, u_a, u_t (k, joints, 4) and which count, 0 or 1 (k, joints)."""

    r: FloatArray
    actual_rate: FloatArray
    target_rate: FloatArray
    known: FloatArray


def prepare(stretch: Stretch, bandwidth_s: float) -> Comparison:
    """Make a stretch ready to be compared at any lag."""
    starts = stretch.block_starts
    lengths = np.diff(np.append(starts, len(stretch.at_s)))
    actual = smoothed(stretch.actual, stretch.at_s, bandwidth_s)
    block = np.repeat(np.arange(len(starts)), lengths)
    return Comparison(stretch, bandwidth_s, actual, starts, block)


def refine(comparisons: Sequence[Comparison], lag_s: float) -> Fit:
    """Go from a coarse lag to the best one nearby."""
    scale: FloatArray | None = None
    for step in range(_MOST_STEPS):
        sums = [_block_sums(one, lag_s, scale) for one in comparisons]
        top, bottom, rms, count = (np.concatenate(piece) for piece in zip(*sums, strict=True))
        total = float(bottom.sum())
        change_s = -float(top.sum()) / total if total > 0.0 else 0.0
        # The first step has no weights yet, so that its scale is not the last one's.
        if step > 1 and abs(change_s) < _SMALL_STEP_S:
            break
        lag_s += float(np.clip(change_s, -_LARGEST_STEP_S, _LARGEST_STEP_S))
        scale = _scale(rms, count)
    return Fit(lag_s, _scale(rms, count), top, bottom)


def misfit(comparisons: Sequence[Comparison], lag_s: float, scale: FloatArray) -> FloatArray:
    """Return, (blocks,), the mean squared difference at a lag in units of each joint's scale.

    Differences beyond three scales count as three, so that a glitch decides nothing.
    """
    blocks = []
    for one in comparisons:
        found = _compare(one, lag_s)
        r = _centred(found.r, found.known, one)
        squared = np.minimum(np.einsum("tjc,tjc->tj", r, r) / scale**2, 9.0) * found.known
        count = np.add.reduceat(found.known.sum(axis=1), one.starts)
        blocks.append(np.add.reduceat(squared.sum(axis=1), one.starts) / np.maximum(count, 1.0))
    return np.concatenate(blocks)


def _block_sums(
    one: Comparison, lag_s: float, scale: FloatArray | None
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Parts of the sums (blocks,); rms differences and how many there are (blocks, joints)."""
    found = _compare(one, lag_s)
    r = _centred(found.r, found.known, one)
    squared = np.einsum("tjc,tjc->tj", r, r) * found.known
    count = np.add.reduceat(found.known, one.starts)
    rms = np.sqrt(np.add.reduceat(squared, one.starts) / np.maximum(count, 1.0))
    weight = found.known
    if scale is not None:
        size = np.maximum(np.sqrt(squared), 1e-12)
        weight = weight * np.minimum(1.0, _HUBER_SCALES * scale / size) / scale**2
        r = _centred(found.r, weight, one)
    actual_rate = _centred(found.actual_rate, weight, one)
    target_rate = _centred(found.target_rate, weight, one)
    top = np.einsum("tjc,tjc,tj->t", r, 0.5 * (actual_rate + target_rate), weight)
    bottom = np.einsum("tjc,tjc,tj->t", actual_rate, target_rate, weight)
    return np.add.reduceat(top, one.starts), np.add.reduceat(bottom, one.starts), rms, count


def _compare(one: Comparison, lag_s: float) -> _Differences:
    """Lay the target of a while ago beside the actual body, on the same hemisphere."""
    actual = one.actual
    target = smoothed(one.stretch.target, one.stretch.at_s - lag_s, one.bandwidth_s)
    along = np.einsum("tjc,tjc->tj", actual.values, target.values)
    sign = np.where(along < 0.0, -1.0, 1.0)[..., np.newaxis]
    known = np.broadcast_to(actual.known & target.known, along.shape).astype(np.float64)
    return _Differences(
        actual.values - sign * target.values, actual.rates, sign * target.rates, known
    )


def _centred(values: FloatArray, weight: FloatArray, one: Comparison) -> FloatArray:
    """Take each block's weighted mean off each joint."""
    total = np.add.reduceat(weight, one.starts)
    sums = np.add.reduceat(values * weight[..., np.newaxis], one.starts)
    mean = sums / np.where(total > 0.0, total, 1.0)[..., np.newaxis]
    return values - mean[one.block]


def _scale(rms: FloatArray, count: FloatArray) -> FloatArray:
    """Each joint's median over the blocks in which it is known: a glitch spoils only its block."""
    medians = [
        float(np.median(own[seen])) if seen.any() else 0.0
        for own, seen in zip(rms.T, count.T > 0.0, strict=True)
    ]
    return np.maximum(medians, _LEAST_SCALE)
