"""The latency that a phase really had, measured from the recorded streams.

A study sets a latency; what participants got may differ: a busy headset, a wrong buffer or a
physics controller that follows slowly add to it. Both bodies are recorded with one clock, the
headset's, so the achieved latency is the lag at which the target's movement, shifted in time, best
fits that of the actual body. All joints except the hips count (the hips are not delayed), each by
its local rotation (parent_from_joint), so that a late trunk is not attributed to the hand.

A coarse search first correlates angular velocities; a fine search then finds the lag to a small
fraction of a frame by least squares on the rotations. The 95 % confidence interval comes from how
much blocks of about two seconds disagree. The other modules of `app.science.latency` contain the
individual steps, with formulas and sources.

What the number means:

- It is an *effective* delay, an average over the movement that took place. If the actual body is
  not a copy but follows with physics, its mean lag is included: a controller that works like a
  filter adds the filter's group delay at the frequencies of human movement, below about 5 Hz.
- It is the delay between the two streams. Delays of tracking, rendering and display are not
  included.
- It is one number for the whole phase. A delay that changes on the way is noticed: up to four
  pieces of the phase, with at least five seconds of movement each, are measured on their own. Where
  two of them differ by more than two tolerances and their intervals do not overlap, `changed` is
  true, the latency is only an average over the phase, and `reason` lists the pieces. For changes
  that are over within a piece, each second is correlated on its own (`moments`): `changed` is true,
  too, where three seconds and a twentieth of them deviate by more than two tolerances, and `reason`
  says for how long. Shorter changes show only in the width of the interval.
- A movement that repeats itself fits at several lags. Where the data cannot decide between them,
  the smallest lag that is not negative is returned, and `reason` lists the others.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import permutations

import numpy as np

from app.science.latency.choice import choose, half_width_s
from app.science.latency.correlation import Correlation, correlate
from app.science.latency.moments import Moments, moments_of
from app.science.latency.refinement import prepare
from app.science.latency.smoothing import BoolArray, Track, track_of
from app.science.latency.stretches import Stretch, stretches
from app.science.rotations import FloatArray
from app.science.skeleton import JOINT_COUNT

LEAST_MOVEMENT_S = 5.0
MOVING_DEG_S = 20.0
LOWEST_S, HIGHEST_S = -0.1, 1.5
TOLERANCE_S = 0.010
# Unrelated bodies, reversed time or a delay that changed half-way stay below it.
_LEAST_CORRELATION = 0.6
_WIDEST_HALF_S = 0.1
_BANDWIDTH_S = 0.02
_MOST_PIECES = 4


class AchievedLatencyError(ValueError):
    """The streams do not have the required shapes, or the range of lags is invalid."""


@dataclass(frozen=True, eq=False)
class StreamPair:
    """The target and the actual stream of one client run, on that run's own clock.

    Attributes:
        target_times_s: (n,) times of the target's frames, starting one lag before the phase; may
            contain invalid times.
        target_rotations: (n, 22, 4) local rotations wxyz; invalid ones are left out joint by joint.
        actual_times_s: (m,) times of the phase's frames.
        actual_rotations: (m, 22, 4) local rotations wxyz.
        active: (m,) mask of the actual frames that are in active time; only these are compared.
    """

    target_times_s: FloatArray
    target_rotations: FloatArray
    actual_times_s: FloatArray
    actual_rotations: FloatArray
    active: BoolArray


@dataclass(frozen=True)
class AchievedLatency:
    """The achieved latency of a phase, or why it is unknown; seconds.

    Attributes:
        latency_s: the lag of the actual body behind the target; None where it is unknown.
        low_s, high_s: the latency's 95 % confidence interval.
        movement_s: active time during which the target's fastest joint turned above 20 deg/s.
        samples: number of active frames of the actual body with at least one usable joint.
        frame_s: median interval between frames of the actual body.
        correlation: the correlation of all angular velocities at the best lag, -1 to 1.
        reason: the reason why there is no latency, or a reservation about it; else None.
        pieces_s: the latency of each piece of the phase, in order; None where one is unknown. Empty
            if there is too little movement for two pieces.
        changed: whether pieces or single seconds differ: the delay was not the same throughout.
    """

    latency_s: float | None
    low_s: float | None
    high_s: float | None
    movement_s: float
    samples: int
    frame_s: float | None
    correlation: float | None = None
    reason: str | None = None
    pieces_s: tuple[float | None, ...] = ()
    changed: bool = False


def achieved_latency(
    target_times_s: FloatArray,
    target_rotations: FloatArray,
    actual_times_s: FloatArray,
    actual_rotations: FloatArray,
    *,
    active: BoolArray | None = None,
    lowest_s: float = LOWEST_S,
    highest_s: float = HIGHEST_S,
) -> AchievedLatency:
    """Measure the latency between two streams on one clock; see `StreamPair` for the arguments.

    All frames count as active if `active` is None.

    Raises:
        AchievedLatencyError: as for `latency_of_runs`.
    """
    every = np.ones(np.shape(actual_times_s), dtype=np.bool_) if active is None else active
    run = StreamPair(target_times_s, target_rotations, actual_times_s, actual_rotations, every)
    return latency_of_runs([run], lowest_s=lowest_s, highest_s=highest_s)


def latency_of_runs(
    runs: Sequence[StreamPair], *, lowest_s: float = LOWEST_S, highest_s: float = HIGHEST_S
) -> AchievedLatency:
    """Measure the latency of a phase from all client runs that took part in it.

    Args:
        runs: the streams of any number of runs; each is compared on its own clock, and one lag is
            fitted to all of them.
        lowest_s, highest_s: the range of lags to search.

    Raises:
        AchievedLatencyError: the shapes differ from those of `StreamPair`, or the range of lags is
            invalid.
    """
    if not (math.isfinite(lowest_s) and math.isfinite(highest_s) and lowest_s < highest_s):
        raise AchievedLatencyError(
            f"The lags {lowest_s} s to {highest_s} s are not a range:"
            " give two ascending finite numbers."
        )
    tracks = [_tracks(run) for run in runs]
    whole = _measured(tracks, lowest_s, highest_s)
    count = min(_MOST_PIECES, int(whole.movement_s // LEAST_MOVEMENT_S))
    if count < 2:
        return whole
    pieces = [_measured(piece, lowest_s, highest_s) for piece in _pieces(tracks, count)]
    compared = _compared(whole, pieces)
    if compared.changed:
        return compared
    found = moments_of(
        list(stretches(tracks)),
        lowest_s,
        highest_s,
        moving_rad_s=math.radians(MOVING_DEG_S),
        least_s=2.0 * tolerance_s(whole),
    )
    return compared if found is None or not found.changed else _with_moments(compared, found)


def _with_moments(whole: AchievedLatency, found: Moments) -> AchievedLatency:
    """Say that single seconds of the phase have another delay than the usual one."""
    others = sorted(found.deviating_s)
    low, high = _ms(others[0]), _ms(others[-1])
    span = f"{low} ms" if low == high else f"{low} to {high} ms"
    told = (
        f"The delay changed for moments: it was {_ms(found.usual_s)} ms in the median second of"
        f" movement, and {span} in {len(others)} of {found.clear}."
    )
    reason = told if whole.reason is None else f"{whole.reason} {told}"
    return replace(whole, reason=reason, changed=True)


def _measured(
    tracks: Sequence[tuple[Track, Track]], lowest_s: float, highest_s: float
) -> AchievedLatency:
    """Measure the latency of (target, actual) tracks as one, whether or not it changes."""
    parts = list(stretches(tracks))
    samples = sum(int((actual.active & actual.valid.any(axis=1)).sum()) for _, actual in tracks)
    unknown = AchievedLatency(None, None, None, 0.0, samples, _frame_s(tracks))
    if not parts:
        return replace(unknown, reason="There are no active frames of both bodies.")
    coarse = correlate(parts, lowest_s, highest_s, math.radians(MOVING_DEG_S))
    unknown = replace(unknown, movement_s=coarse.movement_s, correlation=float(coarse.values.max()))
    if coarse.movement_s < LEAST_MOVEMENT_S:
        return replace(unknown, reason=_little_movement(coarse.movement_s))
    return _refine(parts, coarse, unknown)


def _pieces(
    tracks: Sequence[tuple[Track, Track]], count: int
) -> Iterator[list[tuple[Track, Track]]]:
    """Divide tracks into pieces with equal numbers of active frames, in order."""
    ends = np.cumsum([int(actual.active.sum()) for _, actual in tracks])
    for piece in range(count):
        low, high = piece * ends[-1] // count, (piece + 1) * ends[-1] // count
        found = []
        for (target, actual), end in zip(tracks, ends, strict=True):
            number = end - actual.active.sum() + np.cumsum(actual.active) - 1
            within: BoolArray = actual.active & (number >= low) & (number < high)
            found.append((target, replace(actual, active=within)))
        yield found


def _compared(whole: AchievedLatency, pieces: Sequence[AchievedLatency]) -> AchievedLatency:
    """Add the pieces to the latency of the whole phase, and say so if they differ."""
    pieces_s = tuple(piece.latency_s for piece in pieces)
    # A piece whose movement repeats itself may be a whole repetition off.
    known = [piece for piece in pieces if piece.latency_s is not None and piece.reason is None]
    least_s = 2.0 * tolerance_s(whole)
    changed = any(
        (later.low_s or 0.0) > (earlier.high_s or 0.0)
        and (later.latency_s or 0.0) - (earlier.latency_s or 0.0) > least_s
        for earlier, later in permutations(known, 2)
    )
    if not changed:
        return replace(whole, pieces_s=pieces_s)
    listed = ", ".join("unknown" if one is None else f"{_ms(one)} ms" for one in pieces_s)
    reason = f"The delay changed during the phase; its pieces, in order: {listed}."
    if whole.latency_s is None and whole.reason is not None:
        reason = f"{whole.reason} {reason}"
    return replace(whole, reason=reason, pieces_s=pieces_s, changed=True)


def tolerance_s(achieved: AchievedLatency) -> float:
    """Return the accepted deviation of the latency: 10 ms, or one frame where that is longer."""
    return max(TOLERANCE_S, achieved.frame_s or 0.0)


def is_off(achieved: AchievedLatency, ordered_s: float) -> bool:
    """Return whether the latency differs from the set one by more than the tolerance, or changed.

    False where the latency is unknown and is not known to have changed.
    """
    if achieved.changed:
        return True
    if achieved.latency_s is None:
        return False
    return abs(achieved.latency_s - ordered_s) > tolerance_s(achieved)


def _refine(
    parts: Sequence[Stretch], coarse: Correlation, unknown: AchievedLatency
) -> AchievedLatency:
    """Refine the result of the coarse search.

    Where no lag can be determined, return `unknown` with the reason.
    """
    highest = float(coarse.values.max())
    if highest < _LEAST_CORRELATION:
        reason = "The rotations of the two bodies do not match at any lag"
        return replace(unknown, reason=f"{reason} (correlation {highest:.2f}).")
    slowest_s = max(track.frame_s for part in parts for track in (part.target, part.actual))
    comparisons = [prepare(part, max(_BANDWIDTH_S, slowest_s)) for part in parts]
    chosen = choose(comparisons, coarse)
    if chosen is None:
        reason = (
            f"The best lag lies outside {_ms(coarse.lags_s[0])} to {_ms(coarse.lags_s[-1])} ms."
        )
        return replace(unknown, reason=reason)
    fit, others = chosen
    half_s = half_width_s(fit)
    if half_s > _WIDEST_HALF_S:
        reason = f"The lag is uncertain by more than {_ms(_WIDEST_HALF_S)} ms."
        return replace(unknown, reason=reason)
    return replace(
        unknown,
        latency_s=fit.lag_s,
        low_s=fit.lag_s - half_s,
        high_s=fit.lag_s + half_s,
        reason=_repeats(others),
    )


def _little_movement(movement_s: float) -> str:
    return (
        f"{_tenths(movement_s)} s of movement above {MOVING_DEG_S:g} deg/s;"
        f" {LEAST_MOVEMENT_S:g} s are needed."
    )


def _tenths(time_s: float) -> str:
    # Truncated, not rounded: 4.97 s must not be printed as the 5.0 s that would be enough.
    return f"{math.floor(time_s * 10.0) / 10.0:.1f}"


def _repeats(others: Sequence[float]) -> str | None:
    if not others:
        return None
    lags = " and ".join(_ms(lag_s) for lag_s in others)
    return f"The movement repeats itself: {lags} ms would fit as well."


def _ms(time_s: float) -> str:
    return f"{1000.0 * time_s:.0f}"


def _frame_s(tracks: Sequence[tuple[Track, Track]]) -> float | None:
    steps = [np.diff(actual.times_s) for _, actual in tracks]
    together = np.concatenate(steps) if steps else np.empty(0)
    return float(np.median(together)) if together.size else None


def _tracks(run: StreamPair) -> tuple[Track, Track]:
    shapes = (np.shape(run.target_times_s), np.shape(run.target_rotations))
    others = (np.shape(run.actual_times_s), np.shape(run.actual_rotations))
    for times, rotations in (shapes, others):
        if len(times) != 1 or rotations != (*times, JOINT_COUNT, 4):
            raise AchievedLatencyError(
                f"Times {times} and rotations {rotations} do not fit: (n,) and (n, 22, 4) do."
            )
    if np.shape(run.active) != others[0]:
        raise AchievedLatencyError(
            f"active {np.shape(run.active)} does not fit: give one value for each actual frame."
        )
    every = np.ones(shapes[0], dtype=np.bool_)
    return (
        track_of(run.target_times_s, run.target_rotations[:, 1:], every),
        track_of(run.actual_times_s, run.actual_rotations[:, 1:], run.active),
    )
