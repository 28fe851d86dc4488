"""Fine search for the lag at which the two bodies' rotations differ least, by Gauss-Newton.

At the lag tau the actual rotation q_a(t) of a joint is compared with the target's q_t(t - tau).
Both are smooth curves (see `smoothing`), as vectors of four on the same hemisphere, where
|q_a - q_t| = 2 sin(angle / 4). A small change of the lag changes the difference along the rate u:

    r = q_a(t) - q_t(t - tau) ~ -delta u,    delta = - sum w r.u / sum w u_a.u_t,

with u the mean of both bodies' rates u_a and u_t. The rates' noise is independent between the
bodies, so it does not inflate the denominator. From r and the rates the mean of each joint in each
block is subtracted first: a limb that hangs too low for two seconds is no evidence about time. The
weights w are one over the joint's variance, and smaller for outlying differences (Huber).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.science.latency.smoothing import Curves, smoothed
from app.science.latency.stretches import Stretch
from app.science.rotations import FloatArray

# A tenth of a degree, as a chord: no tracker is more precise from frame to frame.
_LEAST_SCALE = float(np.radians(0.1)) / 2.0
_HUBER_SCALES = 2.5
_MOST_STEPS = 8
_LARGEST_STEP_S = 0.05
_SMALL_STEP_S = 1e-6


@dataclass(frozen=True, eq=False)
class Comparison:
    """A stretch with its actual body smoothed once, to be compared at any lag.

    `actual` are its curves at the stretch's active times (k,); `starts` (blocks,) are the indices
    of these times at which each block begins, `block` (k,) the block of each time.
    """

    stretch: Stretch
    bandwidth_s: float
    actual: Curves
    starts: npt.NDArray[np.intp]
    block: npt.NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Fit:
    """The result of a fine search.

    Attributes:
        lag_s: the lag, s.
        scale: (joints,) typical size of a difference, as a chord.
        top, bottom: (blocks,) each block's part of the numerator and the denominator of delta at
            that lag.
    """

    lag_s: float
    scale: FloatArray
    top: FloatArray
    bottom: FloatArray


@dataclass(frozen=True, eq=False)
class _Differences:
    """Differences of two bodies at one lag: r and the rates u_a and u_t, each (k, joints, 4).

    `known` (k, joints) is 1 where a difference counts, else 0.
    """

    r: FloatArray
    actual_rate: FloatArray
    target_rate: FloatArray
    known: FloatArray


def prepare(stretch: Stretch, bandwidth_s: float) -> Comparison:
    """Smooth the actual body of a stretch and divide it into blocks, for comparisons at any lag."""
    starts = stretch.block_starts
    lengths = np.diff(np.append(starts, len(stretch.at_s)))
    actual = smoothed(stretch.actual, stretch.at_s, bandwidth_s)
    block = np.repeat(np.arange(len(starts)), lengths)
    return Comparison(stretch, bandwidth_s, actual, starts, block)


def refine(comparisons: Sequence[Comparison], lag_s: float) -> Fit:
    """Refine a coarse lag to the best lag nearby."""
    scale: FloatArray | None = None
    for step in range(_MOST_STEPS):
        sums = [_block_sums(comparison, lag_s, scale) for comparison in comparisons]
        top, bottom, rms, count = (np.concatenate(piece) for piece in zip(*sums, strict=True))
        total = float(bottom.sum())
        change_s = -float(top.sum()) / total if total > 0.0 else 0.0
        # The first step has no weights yet, so its result does not use the final scale.
        if step > 1 and abs(change_s) < _SMALL_STEP_S:
            break
        lag_s += float(np.clip(change_s, -_LARGEST_STEP_S, _LARGEST_STEP_S))
        scale = _scale(rms, count)
    return Fit(lag_s, _scale(rms, count), top, bottom)


def misfit(comparisons: Sequence[Comparison], lag_s: float, scale: FloatArray) -> FloatArray:
    """Return each block's mean squared difference at a lag, in squared joint scales, (blocks,).

    Differences beyond three scales count as three, so that a single glitch has little influence.
    """
    blocks = []
    for comparison in comparisons:
        differences = _compare(comparison, lag_s)
        r = _centred(differences.r, differences.known, comparison)
        squared = np.minimum(np.einsum("tjc,tjc->tj", r, r) / scale**2, 9.0) * differences.known
        count = np.add.reduceat(differences.known.sum(axis=1), comparison.starts)
        blocks.append(
            np.add.reduceat(squared.sum(axis=1), comparison.starts) / np.maximum(count, 1.0)
        )
    return np.concatenate(blocks)


def _block_sums(
    comparison: Comparison, lag_s: float, scale: FloatArray | None
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return the parts of both sums of delta (blocks,), the rms differences and their numbers.

    The latter two are (blocks, joints).
    """
    differences = _compare(comparison, lag_s)
    r = _centred(differences.r, differences.known, comparison)
    squared = np.einsum("tjc,tjc->tj", r, r) * differences.known
    count = np.add.reduceat(differences.known, comparison.starts)
    rms = np.sqrt(np.add.reduceat(squared, comparison.starts) / np.maximum(count, 1.0))
    weight = differences.known
    if scale is not None:
        size = np.maximum(np.sqrt(squared), 1e-12)
        weight = weight * np.minimum(1.0, _HUBER_SCALES * scale / size) / scale**2
        r = _centred(differences.r, weight, comparison)
    actual_rate = _centred(differences.actual_rate, weight, comparison)
    target_rate = _centred(differences.target_rate, weight, comparison)
    top = np.einsum("tjc,tjc,tj->t", r, 0.5 * (actual_rate + target_rate), weight)
    bottom = np.einsum("tjc,tjc,tj->t", actual_rate, target_rate, weight)
    return (
        np.add.reduceat(top, comparison.starts),
        np.add.reduceat(bottom, comparison.starts),
        rms,
        count,
    )


def _compare(comparison: Comparison, lag_s: float) -> _Differences:
    """Compute the actual body's differences from the target `lag_s` earlier, on one hemisphere."""
    actual = comparison.actual
    target = smoothed(
        comparison.stretch.target, comparison.stretch.at_s - lag_s, comparison.bandwidth_s
    )
    along = np.einsum("tjc,tjc->tj", actual.values, target.values)
    sign = np.where(along < 0.0, -1.0, 1.0)[..., np.newaxis]
    known = np.broadcast_to(actual.known & target.known, along.shape).astype(np.float64)
    return _Differences(
        actual.values - sign * target.values, actual.rates, sign * target.rates, known
    )


def _centred(values: FloatArray, weight: FloatArray, comparison: Comparison) -> FloatArray:
    """Subtract each block's weighted mean from the values of each joint."""
    total = np.add.reduceat(weight, comparison.starts)
    sums = np.add.reduceat(values * weight[..., np.newaxis], comparison.starts)
    mean = sums / np.where(total > 0.0, total, 1.0)[..., np.newaxis]
    return values - mean[comparison.block]


def _scale(rms: FloatArray, count: FloatArray) -> FloatArray:
    """Return each joint's median over the blocks in which it is known, (joints,).

    With the median, a glitch affects only its own block.
    """
    medians = [
        float(np.median(own[seen])) if seen.any() else 0.0
        for own, seen in zip(rms.T, count.T > 0.0, strict=True)
    ]
    return np.maximum(medians, _LEAST_SCALE)
