"""The latency that a phase really had, measured from what was recorded.

A study orders a latency; what participants got is another matter: a busy headset, a wrong buffer
or a physics controller that follows slowly add to it. Both bodies are recorded with one clock, the
headset's, so the achieved latency is the lag at which the target's movement, shifted, fits that of
the actual body best. All joints but the hips count (these are not delayed), each by its local
rotation (parent_from_joint), so that a late trunk is not blamed on the hand.

The lag is first looked for coarsely, by correlating angular velocities, then to a small fraction of
a frame by least squares on the rotations. Its 95 % confidence interval comes from how blocks of
about two seconds disagree. `app.science.latency` holds the steps with formulas and sources.

What the number means:

- It is an *effective* delay, as an average over the movement that took place. If the actual body is
  not a copy but follows with physics, its mean lag is part of it: a controller that works like a
  filter adds the filter's group delay at the frequencies of human movement, below about 5 Hz.
- It is the delay between the two streams. What tracking, rendering and display take is not in it.
- A movement that repeats itself fits at several lags. Where the data cannot tell, the smallest lag
  that is not negative is given, and `reason` says which others fit as well.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.science.latency.choice import choose, half_width_s
from app.science.latency.correlation import Correlation, correlate
from app.science.latency.refinement import prepare
from app.science.latency.smoothing import BoolArray, Track, track_of
from app.science.latency.stretches import Stretch, stretches
from app.science.rotations import FloatArray
from app.science.skeleton import JOINT_COUNT

LEAST_MOVEMENT_S = 5.0
MOVING_DEG_S = 20.0
LOWEST_S, HIGHEST_S = -0.1, 1.5
TOLERANCE_S = 0.010
# Unrelated bodies, time turned round or a delay that changed half-way stay below it.
_LEAST_CORRELATION = 0.6
_WIDEST_HALF_S = 0.1
_BANDWIDTH_S = 0.02


class AchievedLatencyError(ValueError):
    """The streams do not have the shape of streams, or the lags are no range."""


@dataclass(frozen=True, eq=False)
class StreamPair:
    """Both streams of one run of the client, on its clock; runs have clocks of their own.

    Attributes:
        target_times_s: (n,), from one lag before the phase on; may hold anything.
        target_rotations: (n, 22, 4) local rotations wxyz; bad ones are left out joint by joint.
        actual_times_s: (m,) of the phase.
        actual_rotations: (m, 22, 4).
        active: (m,) during which actual frames the phase's clock ran; only these are compared.
    """

    target_times_s: FloatArray
    target_rotations: FloatArray
    actual_times_s: FloatArray
    actual_rotations: FloatArray
    active: BoolArray


@dataclass(frozen=True)
class AchievedLatency:
    """What was found; seconds.

    Attributes:
        latency_s: the lag of the actual body behind the target; None where nothing can be said.
        low_s, high_s: its 95 % confidence interval.
        movement_s: active time during which the target's fastest joint turned above 20 deg/s.
        samples: active frames of the actual body with at least one usable joint.
        frame_s: median time from frame to frame of the actual body.
        correlation: of all angular velocities at the best lag, -1 to 1.
        reason: why there is no latency, or what to keep in mind about it; else None.
    """

    latency_s: float | None
    low_s: float | None
    high_s: float | None
    movement_s: float
    samples: int
    frame_s: float | None
    correlation: float | None = None
    reason: str | None = None


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
    """Find the latency between two streams on one clock; see `StreamPair` for the arguments.

    All frames count as active where `active` is left out.

    Raises:
        AchievedLatencyError: as `latency_of_runs`.
    """
    every = np.ones(np.shape(actual_times_s), dtype=np.bool_) if active is None else active
    run = StreamPair(target_times_s, target_rotations, actual_times_s, actual_rotations, every)
    return latency_of_runs([run], lowest_s=lowest_s, highest_s=highest_s)


def latency_of_runs(
    runs: Sequence[StreamPair], *, lowest_s: float = LOWEST_S, highest_s: float = HIGHEST_S
) -> AchievedLatency:
    """Find the latency of a phase from all runs of the client that took part in it.

    Args:
        runs: none, one or more; each is compared on its own clock, and all decide together.
        lowest_s, highest_s: the lags to look at.

    Raises:
        AchievedLatencyError: shapes other than those of `StreamPair`, or lags that are no range.
    """
    if not (math.isfinite(lowest_s) and math.isfinite(highest_s) and lowest_s < highest_s):
        raise AchievedLatencyError(
            f"Lags from {lowest_s} s to {highest_s} s are no range: give two rising finite numbers."
        )
    tracks = [_tracks(run) for run in runs]
    parts = list(stretches(tracks))
    samples = sum(int((actual.active & actual.valid.any(axis=1)).sum()) for _, actual in tracks)
    nothing = AchievedLatency(None, None, None, 0.0, samples, _frame_s(tracks))
    if not parts:
        return replace(nothing, reason="There are no active frames of both bodies.")
    found = correlate(parts, lowest_s, highest_s, math.radians(MOVING_DEG_S))
    nothing = replace(nothing, movement_s=found.movement_s, correlation=float(found.values.max()))
    if found.movement_s < LEAST_MOVEMENT_S:
        return replace(nothing, reason=_little_movement(found.movement_s))
    return _refined(parts, found, nothing)


def tolerance_s(achieved: AchievedLatency) -> float:
    """Return how far the latency may be off: 10 ms, or one frame where that is longer."""
    return max(TOLERANCE_S, achieved.frame_s or 0.0)


def is_off(achieved: AchievedLatency, ordered_s: float) -> bool:
    """Return whether the latency is off by more than the tolerance; False where it is unknown."""
    if achieved.latency_s is None:
        return False
    return abs(achieved.latency_s - ordered_s) > tolerance_s(achieved)


def _refined(
    parts: Sequence[Stretch], found: Correlation, nothing: AchievedLatency
) -> AchievedLatency:
    """Refine what the coarse search found; `nothing` is what to return, with a reason, if not."""
    highest = float(found.values.max())
    if highest < _LEAST_CORRELATION:
        reason = "The bodies do not turn alike at any one lag"
        return replace(nothing, reason=f"{reason} (correlation {highest:.2f}).")
    slowest_s = max(track.frame_s for part in parts for track in (part.target, part.actual))
    comparisons = [prepare(part, max(_BANDWIDTH_S, slowest_s)) for part in parts]
    chosen = choose(comparisons, found)
    if chosen is None:
        reason = f"The best lag lies outside {_ms(found.lags_s[0])} to {_ms(found.lags_s[-1])} ms."
        return replace(nothing, reason=reason)
    fit, others = chosen
    half_s = half_width_s(fit)
    if half_s > _WIDEST_HALF_S:
        reason = f"The lag stays uncertain by more than {_ms(_WIDEST_HALF_S)} ms."
        return replace(nothing, reason=reason)
    return replace(
        nothing,
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
    # Cut off, not rounded: 4.97 s must not read as the 5.0 s that are enough.
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
            f"active {np.shape(run.active)} does not fit: give one for each actual frame."
        )
    every = np.ones(shapes[0], dtype=np.bool_)
    return (
        track_of(run.target_times_s, run.target_rotations[:, 1:], every),
        track_of(run.actual_times_s, run.actual_rotations[:, 1:], run.active),
    )
