"""A stream of rotations as smooth curves that can be evaluated at any time.

Frames arrive unevenly, with noise, and some are missing. Around each requested time t the
quaternions of a joint are therefore fitted by a straight line with Gaussian weights (local linear
regression),

    q(t + d) ~ value + rate d,    weight exp(-d^2 / 2 b^2),    b the bandwidth,

one component at a time: neighbouring quaternions are nearly parallel once their signs are made
consistent, so the components behave like ordinary signals. The fit has zero phase: it attenuates
fast movement symmetrically in time, and both streams equally. That matters more here than
sharpness. Interpolating between two noisy frames does worse: it averages most half-way between
them, so a search for the best shift would be drawn to half frames.

Source: Fan & Gijbels (1996), "Local polynomial modelling and its applications", section 2.
"""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray, identity, is_unit
from app.science.skeleton import continuous

if TYPE_CHECKING:
    from scipy.sparse import csr_array

BoolArray = npt.NDArray[np.bool_]
_REACH_BANDWIDTHS = 4.0
# A period without samples longer than this many frames is a gap, in which curves are unknown.
_LONGEST_GAP_FRAMES = 4.5


@dataclass(frozen=True, eq=False)
class Track:
    """The usable frames of one stream, in order.

    Attributes:
        times_s: (n,) ascending times of the frames.
        rotations: (n, joints, 4) quaternions, each in the hemisphere of the previous one.
        valid: (n, joints) mask of the usable rotations; (n, 1) if all joints of a frame share it.
        active: (n,) mask of the frames that are in active time.
        frame_s: median interval between frames; NaN with fewer than two frames.
    """

    times_s: FloatArray
    rotations: FloatArray
    valid: BoolArray
    active: BoolArray
    frame_s: float


@dataclass(frozen=True, eq=False)
class Curves:
    """A track evaluated at k requested times.

    Attributes:
        values: (k, joints, 4) near-unit quaternions.
        rates: (k, joints, 4) change of the values per second.
        known: (k, joints or 1) mask of the times with frames close by on both sides; elsewhere
            values and rates are zero.
    """

    values: FloatArray
    rates: FloatArray
    known: BoolArray


def track_of(times_s: FloatArray, rotations: FloatArray, active: BoolArray) -> Track:
    """Keep the frames whose time is finite and later than all previous ones; mask bad rotations.

    Args:
        times_s: (n,) times, which may be unordered or not finite.
        rotations: (n, joints, 4) rotations, which may contain any values.
        active: (n,) mask of the frames that are in active time.
    """
    usable = np.where(np.isfinite(times_s), times_s, -np.inf)
    before = np.concatenate(([-np.inf], np.maximum.accumulate(usable)[:-1]))
    kept = usable > before
    times, q = times_s[kept], np.asarray(rotations[kept], dtype=np.float64)
    with np.errstate(invalid="ignore", over="ignore"):
        valid = is_unit(q)
    frame_s = float(np.median(np.diff(times))) if times.size > 1 else float("nan")
    if valid.all() and valid.size:
        return Track(times, continuous(q), valid[:, :1], active[kept], frame_s)
    return Track(times, continuous(_filled(q, valid)), valid, active[kept], frame_s)


def smoothed(track: Track, at_s: FloatArray, bandwidth_s: float) -> Curves:
    """Evaluate a track at ascending times (k,).

    `bandwidth_s` is the standard deviation of the Gaussian weights.
    """
    track = _around(track, at_s, _REACH_BANDWIDTHS * bandwidth_s)
    if len(track.times_s) == 0:
        nothing = np.zeros((len(at_s), *track.rotations.shape[1:]))
        return Curves(nothing, nothing, np.zeros((len(at_s), 1), dtype=np.bool_))
    weights, first_moment, second_moment = _kernels(track.times_s, at_s, bandwidth_s)
    valid = track.valid.astype(np.float64)
    signal = (track.rotations * valid[..., np.newaxis]).reshape(len(valid), -1)
    s0, s1, s2 = weights @ valid, first_moment @ valid, second_moment @ valid
    shape = (len(at_s), *track.rotations.shape[1:])
    t0 = (weights @ signal).reshape(shape)
    t1 = (first_moment @ signal).reshape(shape)
    spread = s0 * s2 - s1 * s1
    # With fewer than two frames in reach no line can be fitted.
    known = _between_frames(track, at_s) & (spread > 1e-9 * s0 * s0 * bandwidth_s**2) & (s0 > 0.0)
    scale = np.where(known, 1.0 / np.where(known, spread, 1.0), 0.0)
    a, b, c = ((scale * s)[..., np.newaxis] for s in (s0, s1, s2))
    return Curves(c * t0 - b * t1, a * t1 - b * t0, known)


def _around(track: Track, at_s: FloatArray, reach_s: float) -> Track:
    """Return the part of a track that influences these times.

    Long recordings are evaluated one stretch at a time, which bounds the memory.
    """
    reach_s += _LONGEST_GAP_FRAMES * track.frame_s
    low, high = np.searchsorted(track.times_s, (at_s[0] - reach_s, at_s[-1] + reach_s))
    kept = slice(int(low), int(high))
    return replace(
        track,
        times_s=track.times_s[kept],
        rotations=track.rotations[kept],
        valid=track.valid[kept],
        active=track.active[kept],
    )


def _kernels(
    times_s: FloatArray, at_s: FloatArray, bandwidth_s: float
) -> "tuple[csr_array, csr_array, csr_array]":
    """Return the weights (k, n) of each sample at each requested time, and their first two moments.

    The moments are the weights times the distance in time, and times its square.
    """
    from scipy.sparse import csr_array  # slow to import, and rarely needed

    reach_s = _REACH_BANDWIDTHS * bandwidth_s
    first = np.searchsorted(times_s, at_s - reach_s)
    count = np.searchsorted(times_s, at_s + reach_s, side="right") - first
    ends = np.concatenate(([0], np.cumsum(count)))
    columns = np.arange(ends[-1]) - np.repeat(ends[:-1] - first, count)
    distance_s = times_s[columns] - np.repeat(at_s, count)
    weight = np.exp(-0.5 * (distance_s / bandwidth_s) ** 2)
    shape = (len(at_s), len(times_s))
    return cast(
        "tuple[csr_array, csr_array, csr_array]",
        tuple(
            csr_array((weight * distance_s**power, columns, ends), shape=shape)
            for power in (0, 1, 2)
        ),
    )


def _between_frames(track: Track, at_s: FloatArray) -> BoolArray:
    """Return whether the valid frames just before and just after each time are close together."""
    times = track.times_s[:, np.newaxis]
    before = np.maximum.accumulate(np.where(track.valid, times, -np.inf), axis=0)
    after = np.minimum.accumulate(np.where(track.valid, times, np.inf)[::-1], axis=0)[::-1]
    low = np.searchsorted(track.times_s, at_s, side="right") - 1
    high = np.searchsorted(track.times_s, at_s, side="left")
    inside = (low >= 0) & (high < len(times))
    gap_s = after[np.minimum(high, len(times) - 1)] - before[np.maximum(low, 0)]
    close: BoolArray = gap_s <= _LONGEST_GAP_FRAMES * track.frame_s
    return close & inside[:, np.newaxis]


def _filled(rotations: FloatArray, valid: BoolArray) -> FloatArray:
    """Replace each joint's invalid quaternions by its last valid one, or by the identity."""
    last = np.maximum.accumulate(np.where(valid, np.arange(len(valid))[:, np.newaxis], -1), axis=0)
    q = np.take_along_axis(rotations, np.maximum(last, 0)[..., np.newaxis], axis=0)
    return np.where((last >= 0)[..., np.newaxis], q, identity())
