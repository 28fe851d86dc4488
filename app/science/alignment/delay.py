"""The delay between the headset's own head and a tracker on the head, by how fast both turn.

A rigid body's angular speed is the same seen from every world and at every point of the body. So
the two curves of angular speed differ only by a delay (and by noise), however the two worlds lie
and however the tracker is mounted:

    |w_head(t)| = |w_tracker(t + delay)|.

The correlation of both curves over a grid of lags finds the delay to a grid step. It is refined
below a step by regression: near the right delay, tracker(t + lag) = a + b head(t) + c d/dt head(t),
and c / b is by how much the lag is too large. The standard error of c / b is the uncertainty, with
fewer independent samples than there are where successive errors resemble each other. The headset's
curve is the one on the right because it is the steadier one, and noise there would bias the result;
both curves are smoothed alike, which changes no delay.
"""

from dataclasses import dataclass

import numpy as np

from app.science.alignment.poses import FASTEST_RAD_S, AlignmentError, BoolArray, PoseStream
from app.science.rotations import FloatArray, geodesic_angle

LONGEST_DELAY_S = 0.5
"""Delays to either side up to this are searched."""
_GRID_S = 0.01
_SPAN_S = 0.08  # an angular speed is the turn over this time: longer blurs, shorter is noisy
_BELL: FloatArray = np.hanning(13)[1:-1]  # 0.12 s
_LEAST_S = 2.0
_STILL_RAD_S = 0.05  # standard deviation of the speed; noise alone of 0.2 degrees stays below
_ALIKE = 0.6
_ROUNDS = 4
_RESEMBLING = 50  # grid steps: errors half a second apart are independent


@dataclass(frozen=True)
class DelayFit:
    """How much later the tracker's samples come than the headset's.

    Attributes:
        delay_s: what the headset said at time t, the tracker said at t + delay_s.
        uncertainty_s: its standard error.
        correlation: of the two angular speeds at this delay, at most 1.
    """

    delay_s: float
    uncertainty_s: float
    correlation: float


def estimate_delay(
    headset: PoseStream, tracker: PoseStream, longest_s: float = LONGEST_DELAY_S
) -> DelayFit:
    """Return the delay of a tracker on the head, with its uncertainty.

    Args:
        headset: the head by the headset.
        tracker: a tracker that is fixed to the head.
        longest_s: delays from -longest_s to longest_s are searched.

    Raises:
        AlignmentError: `short`, `still`, `unlike` or `delay`.
    """
    tracker = tracker.without_spikes()
    if min(len(headset.times_s), len(tracker.times_s)) < 2:
        raise AlignmentError(
            "short",
            f"The headset has {len(headset.times_s)} samples and the tracker"
            f" {len(tracker.times_s)}: each needs 2 or more.",
        )
    start_s = max(headset.times_s[0], tracker.times_s[0] + longest_s) + _SPAN_S
    end_s = min(headset.times_s[-1], tracker.times_s[-1] - longest_s) - _SPAN_S
    if not end_s - start_s >= _LEAST_S:
        raise AlignmentError(
            "short",
            f"The streams have {max(end_s - start_s, 0.0):.1f} s in common, apart from"
            f" {longest_s:g} s at either end: at least {_LEAST_S:g} s are needed.",
        )
    steps = round(longest_s / _GRID_S)
    grid_s = start_s + _GRID_S * np.arange(int((end_s - start_s) / _GRID_S))
    wide_s = start_s + _GRID_S * np.arange(-steps, len(grid_s) + steps)
    head = _angular_speed(headset, grid_s)
    _check_moving(head)
    correlations = _correlations(head, _angular_speed(tracker, wide_s))
    best = int(np.argmax(correlations))
    if correlations[best] < _ALIKE:
        raise AlignmentError(
            "unlike",
            "Head and tracker turn alike at no delay (correlation"
            f" {max(correlations[best], 0.0):.2f} at best): is this the tracker on the headset,"
            " and is it fixed?",
        )
    if best in {0, 2 * steps}:
        raise AlignmentError(
            "delay",
            f"The delay is not between {-longest_s:g} and {longest_s:g} s: check the clocks.",
        )
    return _refined(head, grid_s, tracker, _GRID_S * (best - steps))


def _angular_speed(stream: PoseStream, times_s: FloatArray) -> FloatArray:
    """Return how fast a thing turns at each time, in rad/s (N,); NaN where it is unknown."""
    _, before, known_before = stream.at(times_s - 0.5 * _SPAN_S)
    _, after, known_after = stream.at(times_s + 0.5 * _SPAN_S)
    speed = geodesic_angle(before, after) / _SPAN_S
    known = (known_before > 0.0) & (known_after > 0.0) & (speed < FASTEST_RAD_S)
    return _smoothed(speed, known)


def _smoothed(values: FloatArray, known: BoolArray) -> FloatArray:
    """Return the means around each known value, with the weights of a bell; else NaN."""
    total = np.convolve(np.where(known, values, 0.0), _BELL, mode="same")
    weight = np.convolve(known.astype(np.float64), _BELL, mode="same")
    return np.where(known, total / np.where(known, weight, 1.0), np.nan)


def _check_moving(head: FloatArray) -> None:
    known = head[np.isfinite(head)]
    if known.size * _GRID_S < _LEAST_S:
        raise AlignmentError(
            "short",
            f"The head is known for {known.size * _GRID_S:.1f} s:"
            f" at least {_LEAST_S:g} s are needed.",
        )
    if float(np.std(known)) < _STILL_RAD_S:
        raise AlignmentError(
            "still",
            "The head hardly turned: look around, to the left and right, up and down.",
        )


def _correlations(head: FloatArray, tracker: FloatArray) -> FloatArray:
    """Return the correlation of `head` (N,) with each stretch of `tracker` (N + 2 L,): (2 L + 1,).

    Unknown samples of either are left out of each correlation.
    """
    a_known, b_known = np.isfinite(head), np.isfinite(tracker)
    a, b = np.where(a_known, head, 0.0), np.where(b_known, tracker, 0.0)
    ones, both = a_known.astype(np.float64), b_known.astype(np.float64)
    count = np.maximum(np.correlate(both, ones, "valid"), 1.0)
    sum_a, sum_aa = np.correlate(both, a, "valid"), np.correlate(both, a**2, "valid")
    sum_b, sum_bb = np.correlate(b, ones, "valid"), np.correlate(b**2, ones, "valid")
    sum_ab = np.correlate(b, a, "valid")
    energy = (sum_aa - sum_a**2 / count) * (sum_bb - sum_b**2 / count)
    value = (sum_ab - sum_a * sum_b / count) / np.sqrt(np.maximum(energy, 1e-12))
    # Where the tracker was mostly lost, a few samples would correlate by chance.
    return np.where(count >= 0.3 * len(head), value, -1.0)


def _refined(head: FloatArray, grid_s: FloatArray, tracker: PoseStream, lag_s: float) -> DelayFit:
    slope = np.gradient(head, _GRID_S)
    uncertainty_s, correlation = np.inf, 0.0
    for _ in range(_ROUNDS):
        late = _angular_speed(tracker, grid_s + lag_s)
        known = np.isfinite(slope) & np.isfinite(late)
        table = np.column_stack((np.ones(known.sum()), head[known], slope[known]))
        solution = np.linalg.lstsq(table, late[known], rcond=None)[0]
        errors = late[known] - table @ solution
        surplus_s = float(np.clip(solution[2] / solution[1], -_GRID_S, _GRID_S))
        lag_s -= surplus_s
        influence = errors * (table @ np.linalg.pinv(table.T @ table)[2])
        uncertainty_s = _sum_spread(influence) / abs(float(solution[1]))
        correlation = float(np.corrcoef(head[known], late[known])[0, 1])
        if abs(surplus_s) < 0.01 * uncertainty_s:
            break
    return DelayFit(lag_s, uncertainty_s, correlation)


def _sum_spread(parts: FloatArray) -> float:
    """Return the standard error of a sum of parts (N,) of which neighbours resemble each other.

    Source: Newey and West (1987), "A simple, positive semi-definite, heteroskedasticity and
    autocorrelation consistent covariance matrix", Econometrica 55:703-708.
    """
    total = float(parts @ parts)
    for lag in range(1, min(_RESEMBLING, len(parts))):
        total += 2.0 * (1.0 - lag / _RESEMBLING) * float(parts[lag:] @ parts[:-lag])
    return float(np.sqrt(max(total, 0.0)))


def repetition(errors: FloatArray) -> float:
    """Return how many successive errors (N, K) say as much as one independent one, at least 1.

    For errors of which each resembles the one before with correlation r, it is (1 + r) / (1 - r).
    Source: Bayley and Hammersley (1946), "The effective number of independent observations in an
    autocorrelated time series", J. Royal Statistical Society (Supplement) 8:184-197.
    """
    energy = float(np.sum(errors**2))
    if energy == 0.0:
        return 1.0
    resemblance = float(np.sum(errors[1:] * errors[:-1])) / energy
    resemblance = min(max(resemblance, 0.0), 0.98)
    return (1.0 + resemblance) / (1.0 - resemblance)
